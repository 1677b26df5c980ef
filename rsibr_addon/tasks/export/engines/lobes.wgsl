// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. The sampler is linear and clamps; the textures have no mips, row 0 at v = 0.
@group(0) @binding(0) var rsibr_light: texture_2d<f32>;
@group(0) @binding(1) var rsibr_lobes: texture_2d_array<f32>;
@group(0) @binding(2) var rsibr_sampler: sampler;

const KERNELS = $kernels;
const LOBES = 4;
const ALBEDOS = 1 + 3 * KERNELS;
const WIDTHS = $widths.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, of the light itself, and of diffuse light
const MIRROR = KERNELS;
const DIFFUSE = KERNELS + 1;
const PLACES = array(
    $places);
// Suns, which GGX itself reflects, with Z up. The first RESOLVED kernels' maps are without them; other kernels
// show the light itself, where that is below CEILING. Lobes narrower than NARROWEST show suns as a mirror, in part
const SUNS = $suns;
const RESOLVED = $resolved;
const SUN_DIRECTIONS = array(
    $directions);
const SUN_IRRADIANCES = array(
    $irradiances);
const CEILING = $ceiling;
const NARROWEST = $narrowest;
// Glass between its F0 and 1: of (1 - cos)^2, and of its 5th, 6th and 7th power
const GLASS = $glass;

// To the axes of the maps. Y is up here; with Z up: return direction
fn rsibr_axes(direction: vec3f) -> vec3f {
  return vec3f(direction.x, -direction.z, direction.y);
}

fn rsibr_map(direction: vec3f, map: i32) -> vec3f {
  let d = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  let side = select(vec2f(1.0), vec2f(-1.0), d.xy < vec2f(0.0));
  let uv = 0.5 + 0.5 * select(d.xy, (1.0 - abs(d.yx)) * side, d.z < 0.0);
  var places = PLACES;
  return textureSampleLevel(rsibr_light, rsibr_sampler, places[map].xy + uv * places[map].zw, 0.0).rgb;
}

fn rsibr_layer(place: vec2f, layer: i32) -> vec4f {
  return textureSampleLevel(rsibr_lobes, rsibr_sampler, place, layer, 0.0);
}

// With the light that bounces between facets: `mean` is that of the Fresnel term.
fn rsibr_gain(mean: vec3f, albedo: vec4f) -> vec3f {
  return 1.0 + mean * albedo.a / (1.0 - mean * (1.0 - albedo.a)) * (1.0 - albedo.r) / albedo.r;
}

// The Fresnel term: white, what rises as a metal's, and what rises as that of glass.
fn rsibr_fresnel(white: vec3f, rise: vec3f, glass: f32, cosine: f32) -> vec3f {
  let c = 1.0 - cosine;
  let fifth = c * c * c * c * c;
  return white + rise * fifth + glass * dot(GLASS, vec4f(c * c, fifth, fifth * c, fifth * c * c));
}

// GGX without its Fresnel term, times n.l; both: view and light, added.
fn rsibr_facets(alpha: f32, normal: vec3f, n_dot_v: f32, n_dot_l: f32, both: vec3f) -> f32 {
  // The sine from a product: 1 less a square near 1 would leave nothing of single precision
  let aside = cross(normal, both);
  let sine2 = dot(aside, aside) / max(dot(both, both), 1e-12);
  let alpha2 = alpha * alpha;
  let facets = alpha2 * (1.0 - sine2) + sine2;
  let light_part = n_dot_l * sqrt(alpha2 + (1.0 - alpha2) * n_dot_v * n_dot_v);
  let view_part = n_dot_v * sqrt(alpha2 + (1.0 - alpha2) * n_dot_l * n_dot_l);
  return n_dot_l * alpha2 / (6.2831853 * facets * facets * (light_part + view_part));
}

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
fn rsibr_shade(base_color: vec3f, metallic: f32, roughness: f32, world_normal: vec3f, world_view: vec3f) -> vec3f {
  let normal = rsibr_axes(world_normal);
  let view_dir = rsibr_axes(world_view);
  let mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  let alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  let place = vec2f((WIDTHS - 0.5 + $an_octave.0 * log2(alpha)) / WIDTHS, mu);
  let albedo = rsibr_layer(place, ALBEDOS);
  let metal = metallic * rsibr_gain(base_color + (1.0 - base_color) / 21.0, albedo);
  var glass = rsibr_gain(vec3f(0.0895), albedo).r;
  let reflected = glass * (0.04 * albedo.r + 0.96 * albedo.b);
  glass *= 1.0 - metallic;
  let white = metal * base_color + 0.04 * glass;
  let rise = metal * (1.0 - base_color);

  let mirror_dir = reflect(-view_dir, normal);
  let up = normal - dot(normal, mirror_dir) * mirror_dir;
  let tilts = rsibr_layer(place, 0);
  var axes: array<vec3f, 4>;
  for (var lobe = 0; lobe < LOBES; lobe++) {
    let tilt = tilts[lobe] * up;
    let angle = max(length(tilt), 1e-6);
    axes[lobe] = cos(angle) * mirror_dir + sin(angle) / angle * tilt;
  }
  var specular = vec3f(0.0);
  for (var kernel = 0; kernel < KERNELS; kernel++) {
    let of_white = rsibr_layer(place, 1 + 3 * kernel);
    if (any(of_white != vec4f(0.0))) {
      let of_rise = rsibr_layer(place, 2 + 3 * kernel);
      let of_glass = rsibr_layer(place, 3 + 3 * kernel);
      for (var lobe = 0; lobe < LOBES; lobe++) {
        let weight = white * of_white[lobe] + rise * of_rise[lobe] + 0.96 * glass * of_glass[lobe];
        let shown = rsibr_map(axes[lobe], kernel);
        specular += weight * select(min(shown, CEILING), shown, kernel < RESOLVED);
      }
    }
  }
  let width = min(alpha / NARROWEST, 1.0);
  let rough = width * width;
  if (rough < 1.0) {
    let shown = rsibr_map(mirror_dir, MIRROR);
    specular += (1.0 - rough) * rsibr_fresnel(white, rise, 0.96 * glass, mu) * (shown - min(shown, CEILING));
  }
  specular = max(specular, vec3f(0.0));
  var directions = SUN_DIRECTIONS;
  var irradiances = SUN_IRRADIANCES;
  for (var sun = 0; sun < SUNS; sun++) {
    let light_dir = directions[sun];
    let both = view_dir + light_dir;
    let n_dot_l = max(dot(normal, light_dir), 0.0);
    let h_dot_l = dot(both, light_dir) * inverseSqrt(max(dot(both, both), 1e-12));
    let facets = rough * rsibr_facets(max(alpha, NARROWEST), normal, mu, n_dot_l, both);
    specular += facets * rsibr_fresnel(white, rise, 0.96 * glass, h_dot_l) * irradiances[sun];
  }
  let diffuse = (1.0 - metallic) * (1.0 - reflected);
  return specular + diffuse * base_color * rsibr_map(normal, DIFFUSE);
}

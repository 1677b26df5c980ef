// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. The sampler is linear and clamps; the textures have no mips, row 0 at v = 0.
@group(0) @binding(0) var rsibr_light: texture_2d<f32>;
@group(0) @binding(1) var rsibr_lobes: texture_2d_array<f32>;
@group(0) @binding(2) var rsibr_sampler: sampler;

const KERNELS = 12;
const LOBES = 4;
const ALBEDOS = 37;
const WIDTHS = 33.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, and of diffuse light
const PLACES = array<vec4f, 13>(
    $places);

fn rsibr_map(direction: vec3f, map: i32) -> vec3f {
  var d = vec3f(direction.x, -direction.z, direction.y);  // Y is up; with Z up: d = direction
  d /= abs(d.x) + abs(d.y) + abs(d.z);
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

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
fn rsibr_shade(base_color: vec3f, metallic: f32, roughness: f32, normal: vec3f, view_dir: vec3f) -> vec3f {
  let mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  let alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  let place = vec2f((WIDTHS - 0.5 + 4.0 * log2(alpha)) / WIDTHS, mu);
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
        specular += weight * rsibr_map(axes[lobe], kernel);
      }
    }
  }
  let diffuse = (1.0 - metallic) * (1.0 - reflected);
  return max(specular, vec3f(0.0)) + diffuse * base_color * rsibr_map(normal, KERNELS);
}

// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. GLSL 3.30 or ES 3.00. Both textures are linear, clamped and without mips, row 0 at v = 0.
uniform highp sampler2D rsibr_light;
uniform highp sampler2DArray rsibr_lobes;

const int KERNELS = $kernels, LOBES = 4, ALBEDOS = 1 + 3 * KERNELS;
const float WIDTHS = $widths.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, of the light itself, and of diffuse light
const int MIRROR = KERNELS, DIFFUSE = KERNELS + 1;
const vec4 PLACES[KERNELS + 2] = vec4[](
    $places);
// Suns, which GGX itself reflects, with Z up. The first RESOLVED kernels' maps are without them; other kernels
// show the light itself, where that is below CEILING. Lobes narrower than NARROWEST show suns as a mirror, in part
const int SUNS = $suns, RESOLVED = $resolved;
const vec3 SUN_DIRECTIONS[] = vec3[](
    $directions);
const vec3 SUN_IRRADIANCES[] = vec3[](
    $irradiances);
const vec3 CEILING = $ceiling;
const float NARROWEST = $narrowest;
// Glass between its F0 and 1: of (1 - cos)^2, and of its 5th, 6th and 7th power
const vec4 GLASS = $glass;

// To the axes of the maps. Y is up here; with Z up: return direction
vec3 rsibr_axes(vec3 direction)
{
  return vec3(direction.x, -direction.z, direction.y);
}

vec3 rsibr_map(vec3 d, int map)
{
  d /= abs(d.x) + abs(d.y) + abs(d.z);
  vec2 side = vec2((d.x < 0.0) ? -1.0 : 1.0, (d.y < 0.0) ? -1.0 : 1.0);
  vec2 uv = 0.5 + 0.5 * ((d.z < 0.0) ? (1.0 - abs(d.yx)) * side : d.xy);
  return textureLod(rsibr_light, PLACES[map].xy + uv * PLACES[map].zw, 0.0).rgb;
}

// With the light that bounces between facets: `mean` is that of the Fresnel term.
vec3 rsibr_gain(vec3 mean, vec4 albedo)
{
  return 1.0 + mean * albedo.a / (1.0 - mean * (1.0 - albedo.a)) * (1.0 - albedo.r) / albedo.r;
}

// The Fresnel term: white, what rises as a metal's, and what rises as that of glass.
vec3 rsibr_fresnel(vec3 white, vec3 rise, float glass, float cosine)
{
  float c = 1.0 - cosine, fifth = c * c * c * c * c;
  return white + rise * fifth + glass * dot(GLASS, vec4(c * c, fifth * vec3(1.0, c, c * c)));
}

// GGX without its Fresnel term, times n.l; both: view and light, added.
float rsibr_facets(float alpha, vec3 normal, float n_dot_v, float n_dot_l, vec3 both)
{
  // The sine from a product: 1 less a square near 1 would leave nothing of single precision
  vec3 aside = cross(normal, both);
  float sine2 = dot(aside, aside) / max(dot(both, both), 1e-12), alpha2 = alpha * alpha;
  float facets = alpha2 * (1.0 - sine2) + sine2;
  float light_part = n_dot_l * sqrt(alpha2 + (1.0 - alpha2) * n_dot_v * n_dot_v);
  float view_part = n_dot_v * sqrt(alpha2 + (1.0 - alpha2) * n_dot_l * n_dot_l);
  return n_dot_l * alpha2 / (6.2831853 * facets * facets * (light_part + view_part));
}

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
vec3 rsibr_shade(vec3 base_color, float metallic, float roughness, vec3 normal, vec3 view_dir)
{
  normal = rsibr_axes(normal);
  view_dir = rsibr_axes(view_dir);
  float mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  float alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  vec2 place = vec2((WIDTHS - 0.5 + $an_octave.0 * log2(alpha)) / WIDTHS, mu);
  vec4 albedo = textureLod(rsibr_lobes, vec3(place, float(ALBEDOS)), 0.0);
  vec3 metal = metallic * rsibr_gain(base_color + (1.0 - base_color) / 21.0, albedo);
  float glass = rsibr_gain(vec3(0.0895), albedo).r;
  float reflected = glass * (0.04 * albedo.r + 0.96 * albedo.b);
  glass *= 1.0 - metallic;
  vec3 white = metal * base_color + 0.04 * glass, rise = metal * (1.0 - base_color);

  vec3 mirror_dir = reflect(-view_dir, normal);
  vec3 up = normal - dot(normal, mirror_dir) * mirror_dir;
  vec4 tilts = textureLod(rsibr_lobes, vec3(place, 0.0), 0.0);
  vec3 axes[LOBES];
  for (int lobe = 0; lobe < LOBES; lobe++) {
    vec3 tilt = tilts[lobe] * up;
    float angle = max(length(tilt), 1e-6);
    axes[lobe] = cos(angle) * mirror_dir + sin(angle) / angle * tilt;
  }
  vec3 specular = vec3(0.0);
  for (int kernel = 0; kernel < KERNELS; kernel++) {
    float layer = float(1 + 3 * kernel);
    vec4 of_white = textureLod(rsibr_lobes, vec3(place, layer), 0.0);
    if (of_white != vec4(0.0)) {
      vec4 of_rise = textureLod(rsibr_lobes, vec3(place, layer + 1.0), 0.0);
      vec4 of_glass = textureLod(rsibr_lobes, vec3(place, layer + 2.0), 0.0);
      for (int lobe = 0; lobe < LOBES; lobe++) {
        vec3 weight = white * of_white[lobe] + rise * of_rise[lobe] + 0.96 * glass * of_glass[lobe];
        vec3 shown = rsibr_map(axes[lobe], kernel);
        specular += weight * ((kernel < RESOLVED) ? shown : min(shown, CEILING));
      }
    }
  }
  float width = min(alpha / NARROWEST, 1.0), rough = width * width;
  if (rough < 1.0) {
    vec3 shown = rsibr_map(mirror_dir, MIRROR);
    specular += (1.0 - rough) * rsibr_fresnel(white, rise, 0.96 * glass, mu) * (shown - min(shown, CEILING));
  }
  specular = max(specular, 0.0);
  for (int sun = 0; sun < SUNS; sun++) {
    vec3 light_dir = SUN_DIRECTIONS[sun], both = view_dir + light_dir;
    float n_dot_l = max(dot(normal, light_dir), 0.0);
    float h_dot_l = dot(both, light_dir) * inversesqrt(max(dot(both, both), 1e-12));
    float facets = rough * rsibr_facets(max(alpha, NARROWEST), normal, mu, n_dot_l, both);
    specular += facets * rsibr_fresnel(white, rise, 0.96 * glass, h_dot_l) * SUN_IRRADIANCES[sun];
  }
  float diffuse = (1.0 - metallic) * (1.0 - reflected);
  return specular + diffuse * base_color * rsibr_map(normal, DIFFUSE);
}

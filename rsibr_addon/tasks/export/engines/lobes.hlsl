// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. The sampler is linear and clamps; the textures have no mips, row 0 at v = 0.
Texture2D rsibr_light : register(t0);
Texture2DArray rsibr_lobes : register(t1);
SamplerState rsibr_sampler : register(s0);

static const int KERNELS = $kernels, LOBES = 4, ALBEDOS = 1 + 3 * KERNELS;
static const float WIDTHS = $widths.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, of the light itself, and of diffuse light
static const int MIRROR = KERNELS, DIFFUSE = KERNELS + 1;
static const float4 PLACES[KERNELS + 2] = {
    $places};
// Suns, which GGX itself reflects, with Z up. The first RESOLVED kernels' maps are without them; other kernels
// show the light itself, where that is below CEILING. Lobes narrower than NARROWEST show suns as a mirror, in part
static const int SUNS = $suns, RESOLVED = $resolved;
static const float3 SUN_DIRECTIONS[] = {
    $directions};
static const float3 SUN_IRRADIANCES[] = {
    $irradiances};
static const float3 CEILING = $ceiling;
static const float NARROWEST = $narrowest;
// Glass between its F0 and 1: of (1 - cos)^2, and of its 5th, 6th and 7th power
static const float4 GLASS = $glass;

// To the axes of the maps. Y is up here; with Z up: return direction
float3 rsibr_axes(float3 direction)
{
  return float3(direction.x, -direction.z, direction.y);
}

float3 rsibr_map(float3 d, int map)
{
  d /= abs(d.x) + abs(d.y) + abs(d.z);
  float2 side = float2((d.x < 0.0) ? -1.0 : 1.0, (d.y < 0.0) ? -1.0 : 1.0);
  float2 folded = (1.0 - abs(d.yx)) * side;
  float2 uv = 0.5 + 0.5 * ((d.z < 0.0) ? folded : d.xy);
  return rsibr_light.SampleLevel(rsibr_sampler, PLACES[map].xy + uv * PLACES[map].zw, 0.0).rgb;
}

float4 rsibr_layer(float2 place, int layer)
{
  return rsibr_lobes.SampleLevel(rsibr_sampler, float3(place, layer), 0.0);
}

// With the light that bounces between facets: `mean` is that of the Fresnel term.
float3 rsibr_gain(float3 mean, float4 albedo)
{
  return 1.0 + mean * albedo.a / (1.0 - mean * (1.0 - albedo.a)) * (1.0 - albedo.r) / albedo.r;
}

// The Fresnel term: white, what rises as a metal's, and what rises as that of glass.
float3 rsibr_fresnel(float3 white, float3 rise, float glass, float cosine)
{
  float c = 1.0 - cosine, fifth = c * c * c * c * c;
  return white + rise * fifth + glass * dot(GLASS, float4(c * c, fifth, fifth * c, fifth * c * c));
}

// GGX without its Fresnel term, times n.l; both: view and light, added.
float rsibr_facets(float alpha, float3 normal, float n_dot_v, float n_dot_l, float3 both)
{
  // The sine from a product: 1 less a square near 1 would leave nothing of single precision
  float3 aside = cross(normal, both);
  float sine2 = dot(aside, aside) / max(dot(both, both), 1e-12), alpha2 = alpha * alpha;
  float facets = alpha2 * (1.0 - sine2) + sine2;
  float light_part = n_dot_l * sqrt(alpha2 + (1.0 - alpha2) * n_dot_v * n_dot_v);
  float view_part = n_dot_v * sqrt(alpha2 + (1.0 - alpha2) * n_dot_l * n_dot_l);
  return n_dot_l * alpha2 / (6.2831853 * facets * facets * (light_part + view_part));
}

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
float3 rsibr_shade(float3 base_color, float metallic, float roughness, float3 normal, float3 view_dir)
{
  normal = rsibr_axes(normal);
  view_dir = rsibr_axes(view_dir);
  float mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  float alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  float2 place = float2((WIDTHS - 0.5 + $an_octave.0 * log2(alpha)) / WIDTHS, mu);
  float4 albedo = rsibr_layer(place, ALBEDOS);
  float3 metal = metallic * rsibr_gain(base_color + (1.0 - base_color) / 21.0, albedo);
  float glass = rsibr_gain(float3(0.0895, 0.0895, 0.0895), albedo).r;
  float reflected = glass * (0.04 * albedo.r + 0.96 * albedo.b);
  glass *= 1.0 - metallic;
  float3 white = metal * base_color + 0.04 * glass, rise = metal * (1.0 - base_color);

  float3 mirror_dir = reflect(-view_dir, normal);
  float3 up = normal - dot(normal, mirror_dir) * mirror_dir;
  float4 tilts = rsibr_layer(place, 0);
  float3 axes[LOBES];
  for (int axis = 0; axis < LOBES; axis++) {
    float3 tilt = tilts[axis] * up;
    float angle = max(length(tilt), 1e-6);
    axes[axis] = cos(angle) * mirror_dir + sin(angle) / angle * tilt;
  }
  float3 specular = float3(0.0, 0.0, 0.0);
  for (int kernel = 0; kernel < KERNELS; kernel++) {
    float4 of_white = rsibr_layer(place, 1 + 3 * kernel);
    if (any(of_white != 0.0)) {
      float4 of_rise = rsibr_layer(place, 2 + 3 * kernel);
      float4 of_glass = rsibr_layer(place, 3 + 3 * kernel);
      for (int lobe = 0; lobe < LOBES; lobe++) {
        float3 weight = white * of_white[lobe] + rise * of_rise[lobe] + 0.96 * glass * of_glass[lobe];
        float3 shown = rsibr_map(axes[lobe], kernel);
        specular += weight * ((kernel < RESOLVED) ? shown : min(shown, CEILING));
      }
    }
  }
  float width = min(alpha / NARROWEST, 1.0), rough = width * width;
  if (rough < 1.0) {
    float3 shown = rsibr_map(mirror_dir, MIRROR);
    specular += (1.0 - rough) * rsibr_fresnel(white, rise, 0.96 * glass, mu) * (shown - min(shown, CEILING));
  }
  specular = max(specular, 0.0);
  for (int sun = 0; sun < SUNS; sun++) {
    float3 light_dir = SUN_DIRECTIONS[sun], both = view_dir + light_dir;
    float n_dot_l = max(dot(normal, light_dir), 0.0);
    float h_dot_l = dot(both, light_dir) * rsqrt(max(dot(both, both), 1e-12));
    float facets = rough * rsibr_facets(max(alpha, NARROWEST), normal, mu, n_dot_l, both);
    specular += facets * rsibr_fresnel(white, rise, 0.96 * glass, h_dot_l) * SUN_IRRADIANCES[sun];
  }
  float diffuse = (1.0 - metallic) * (1.0 - reflected);
  return specular + diffuse * base_color * rsibr_map(normal, DIFFUSE);
}

// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. The sampler is linear and clamps; the textures have no mips, row 0 at v = 0.
Texture2D rsibr_light : register(t0);
Texture2DArray rsibr_lobes : register(t1);
SamplerState rsibr_sampler : register(s0);

static const int KERNELS = 12, LOBES = 4, ALBEDOS = 1 + 3 * KERNELS;
static const float WIDTHS = 33.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, and of diffuse light
static const float4 PLACES[KERNELS + 1] = {
    $places};

float3 rsibr_map(float3 direction, int map)
{
  float3 d = float3(direction.x, -direction.z, direction.y);  // Y is up; with Z up: d = direction
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

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
float3 rsibr_shade(float3 base_color, float metallic, float roughness, float3 normal, float3 view_dir)
{
  float mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  float alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  float2 place = float2((WIDTHS - 0.5 + 4.0 * log2(alpha)) / WIDTHS, mu);
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
        specular += weight * rsibr_map(axes[lobe], kernel);
      }
    }
  }
  float diffuse = (1.0 - metallic) * (1.0 - reflected);
  return max(specular, 0.0) + diffuse * base_color * rsibr_map(normal, KERNELS);
}

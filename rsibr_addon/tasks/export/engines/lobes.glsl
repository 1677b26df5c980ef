// A metallic-roughness surface in the light of $name.ktx2, shaded with the lobes of $name-lobes.ktx2; written by
// `rsibr export --for lobes`. GLSL 3.30 or ES 3.00. Both textures are linear, clamped and without mips, row 0 at v = 0.
uniform highp sampler2D rsibr_light;
uniform highp sampler2DArray rsibr_lobes;

const int KERNELS = 12, LOBES = 4, ALBEDOS = 1 + 3 * KERNELS;
const float WIDTHS = 33.0;
// Where maps lie in rsibr_light: of kernels, from the broadest on, and of diffuse light
const vec4 PLACES[KERNELS + 1] = vec4[](
    $places);

vec3 rsibr_map(vec3 direction, int map)
{
  vec3 d = vec3(direction.x, -direction.z, direction.y);  // Y is up; with Z up: d = direction
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

// Radiance towards the unit vector view_dir; roughness from 1/16, what is smoother is shown so.
vec3 rsibr_shade(vec3 base_color, float metallic, float roughness, vec3 normal, vec3 view_dir)
{
  float mu = clamp(dot(normal, view_dir), 1e-4, 1.0);
  float alpha = clamp(roughness * roughness, 1.0 / 256.0, 1.0);
  vec2 place = vec2((WIDTHS - 0.5 + 4.0 * log2(alpha)) / WIDTHS, mu);
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
        specular += weight * rsibr_map(axes[lobe], kernel);
      }
    }
  }
  float diffuse = (1.0 - metallic) * (1.0 - reflected);
  return max(specular, 0.0) + diffuse * base_color * rsibr_map(normal, KERNELS);
}

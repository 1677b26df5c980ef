// Twin of rsibr_addon/core/suns.py. A program for light with suns defines SUNS. The last column of `lookups`
// holds, after the places of maps, what device/kinds/kernel_pyramid_texels.py says.
#include "lib/directions_lib.glsl"
#include "lib/fresnel_powers_lib.glsl"

#ifdef SUNS
const bool MAY_HAVE_SUNS = true;
#else
const bool MAY_HAVE_SUNS = false;
#endif

// After the mirror's place, those of both diffuse maps, and of three rings
const int SUNS_ROW = 6;

struct Suns {
  int count;
  // Kernels that have maps of their own.
  int resolved;
  vec3 ceiling;
  float narrowest;
};

vec4 sun_texel(sampler2D lookups, int number)
{
  return texelFetch(lookups, ivec2(textureSize(lookups, 0).x - 1, SUNS_ROW + number), 0);
}

Suns suns_of(sampler2D lookups)
{
  if (!MAY_HAVE_SUNS) {
    return Suns(0, 0, vec3(0.0), 1.0);
  }
  vec4 below = sun_texel(lookups, 0);
  vec4 counts = sun_texel(lookups, 1);
  return Suns(int(counts.x), int(counts.y), below.rgb, below.a);
}

// A sun's direction; its irradiance.
vec3 sun_direction(sampler2D lookups, int sun)
{
  return sun_texel(lookups, 2 + 2 * sun).xyz;
}

vec3 sun_irradiance(sampler2D lookups, int sun)
{
  return sun_texel(lookups, 3 + 2 * sun).rgb;
}

float sun_mirror_share(Suns suns, float alpha)
{
  float width = min(alpha / suns.narrowest, 1.0);
  return 1.0 - width * width;
}

// GGX without its Fresnel term, times n.l; both: view and light, added.
float facets_reflect(float alpha, vec3 normal, float n_dot_v, float n_dot_l, vec3 both)
{
  // The sine from a product: 1 less a square near 1 would leave nothing of single precision
  vec3 aside = cross(normal, both);
  float sine2 = dot(aside, aside) / max(dot(both, both), 1e-12);
  float alpha2 = alpha * alpha;
  float facets = alpha2 * (1.0 - sine2) + sine2;
  float light_part = n_dot_l * sqrt(alpha2 + (1.0 - alpha2) * n_dot_v * n_dot_v);
  float view_part = n_dot_v * sqrt(alpha2 + (1.0 - alpha2) * n_dot_l * n_dot_l);
  return n_dot_l * alpha2 / (2.0 * PI * facets * facets * (light_part + view_part));
}

vec3 sunlit_gloss(
    sampler2D lookups, Suns suns, float alpha, float mu, Powers coefficients, vec3 normal, vec3 view_dir)
{
  vec3 radiance = vec3(0.0);
  float width = max(alpha, suns.narrowest);
  for (int sun = 0; sun < suns.count; sun++) {
    vec3 light_dir = sun_direction(lookups, sun);
    vec3 both = view_dir + light_dir;
    float shown = facets_reflect(width, normal, mu, max(dot(normal, light_dir), 0.0), both);
    float h_dot_l = dot(both, light_dir) * inversesqrt(max(dot(both, both), 1e-12));
    vec3 color = coefficients.zeroth + coefficients.rising * powers_of(h_dot_l);
    radiance += shown * color * sun_irradiance(lookups, sun);
  }
  return (1.0 - sun_mirror_share(suns, alpha)) * radiance;
}

// What facets that lean add to diffuse light: core/brdf/oren_nayar.py `tilt`.
vec3 sunlit_leaning(sampler2D lookups, Suns suns, float mu, vec3 normal, vec3 view_dir)
{
  vec3 radiance = vec3(0.0);
  for (int sun = 0; sun < suns.count; sun++) {
    vec3 light_dir = sun_direction(lookups, sun);
    float n_dot_l = max(dot(normal, light_dir), 0.0);
    float apart = dot(light_dir, view_dir) - n_dot_l * mu;
    float tilt = (apart > 0.0) ? apart / max(n_dot_l, mu) : apart;
    radiance += n_dot_l * tilt * sun_irradiance(lookups, sun);
  }
  return radiance;
}

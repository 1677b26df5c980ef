// Twin of rsibr_addon/core/kinds/mip_chain/near_diffuse.py.
#include "lib/directions_lib.glsl"
#include "lib/mip_chain_lib.glsl"
#include "lib/probes_lib.glsl"

const int COSINE_LOBES = 14;

// The axis of one of the lobes that make up the cosine about a normal, and its share.
vec4 cosine_lobe(vec3 normal, int number)
{
  int ring = (number < 1) ? 0 : (number < 6) ? 1 : 2;
  float count = vec3(1.0, 5.0, 8.0)[ring];
  float away = radians(vec3(0.0, 35.0, 62.0)[ring]);
  float share = vec3(0.110, 0.490, 0.400)[ring];
  float within = float(number) - vec3(0.0, 1.0, 6.0)[ring];
  float azimuth = 2.0 * PI * (within + 0.5 * float(ring)) / count;
  vec3 local = vec3(sin(away) * cos(azimuth), sin(away) * sin(azimuth), cos(away));
  return vec4(camera_frame(normal) * local, share / count);
}

// Irradiance over pi, at a point in world coordinates.
vec3 near_diffuse(sampler2D atlas, float bottom, float level, Place place, vec3 position, vec3 normal)
{
  vec3 light = vec3(0.0);
  for (int number = 0; number < COSINE_LOBES; number++) {
    vec4 lobe = cosine_lobe(normal, number);
    vec3 direction = near_direction(place, position, lobe.xyz);
    light += lobe.w * glossy_radiance(atlas, bottom, direction, level, false);
  }
  return light;
}

// Twin of rsibr_addon/core/maps/equirect.py. A map comes as a texture with a border of one texel that repeats
// the texels across the seam and the poles (see device/kinds/reflection_tables.py), so that hardware
// interpolates there.
#include "lib/directions_lib.glsl"

vec2 equirect_uv(vec3 direction)
{
  // GLSL leaves atan(0, 0) open; the poles have u = 0.5, as in the twin.
  bool pole = direction.x == 0.0 && direction.y == 0.0;
  float azimuth = pole ? 0.0 : atan(direction.y, direction.x);
  float polar = atan(length(direction.xy), direction.z);
  return vec2(0.5 - azimuth / (2.0 * PI), 1.0 - polar / PI);
}

vec3 equirect_radiance(sampler2D bordered, vec3 direction)
{
  vec2 size = vec2(textureSize(bordered, 0));
  vec2 uv = (equirect_uv(direction) * (size - 2.0) + 1.0) / size;
  return textureLod(bordered, uv, 0.0).rgb;
}

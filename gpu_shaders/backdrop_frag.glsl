// An environment as it is seen behind all surfaces.
#include "lib/equirect_lib.glsl"

void main()
{
  vec2 place = 2.0 * map_uv - 1.0;
  vec4 near = environment_from_clip * vec4(place, -1.0, 1.0);
  vec4 far = environment_from_clip * vec4(place, 1.0, 1.0);
  vec3 ahead = normalize(far.xyz / far.w - near.xyz / near.w);
  colour = vec4(scale * equirect_radiance(environment, ahead), 1.0);
}

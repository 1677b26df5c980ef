// The environment's own map, first in the atlas, from six faces within their borders.
#include "lib/live_pyramid_lib.glsl"
#include "lib/mip_chain_lib.glsl"

void main()
{
  vec3 direction = bordered_direction(gl_FragCoord.xy - 1.0, float(width));
  texel = vec4(mip_radiance(faces, 0.0, 0, cube_place(direction), false), 1.0);
}

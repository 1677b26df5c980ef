// A map of the pyramid, of a sharper one.
#include "lib/live_pyramid_lib.glsl"

void main()
{
  vec3 own = texelFetch(taps, ivec2(1, row), 0).xyz;
  vec3 axis = bordered_direction(gl_FragCoord.xy - own.xy, own.z);
  texel = vec4(tapped_radiance(sources, taps, row, axis), 1.0);
}

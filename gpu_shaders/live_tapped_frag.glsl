// A map of the pyramid, of a sharper one. Those by the normal show suns too, which are in no face.
#include "lib/live_pyramid_lib.glsl"

void main()
{
  vec3 own = texelFetch(taps, ivec2(1, row), 0).xyz;
  vec2 by_normal = texelFetch(taps, ivec2(2, row), 0).xy;
  vec3 axis = bordered_direction(gl_FragCoord.xy - own.xy, own.z);
  vec3 light = tapped_radiance(sources, taps, row, axis);
  if (MAY_HAVE_SUNS && by_normal.x > 0.0) {
    light += sunlit_by_normal(lookups, int(by_normal.x), by_normal.y, axis);
  }
  texel = vec4(light, 1.0);
}

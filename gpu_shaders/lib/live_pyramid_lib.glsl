// Twin of rsibr_addon/core/kinds/kernel_pyramid/live.py. A row of `taps` (see device/kinds/live_pyramid.py)
// tells of one map: where in the atlas the map lies that it is made of, as pyramid_lib.glsl has it, and the
// number of lookups; its own corner and width in texels, its border apart; and the lookups.
#include "lib/directions_lib.glsl"
#include "lib/pyramid_lib.glsl"

const int FIRST_TAP = 2;

// What a pixel of a map shows, or of its border: each edge is folded about its middle.
vec3 bordered_direction(vec2 pixel, float width)
{
  vec2 uv = pixel / width;
  bvec2 beyond = notEqual(uv, clamp(uv, 0.0, 1.0));
  vec2 folded = mix(uv, 1.0 - abs(1.0 - abs(uv)), vec2(beyond));
  return octahedral_direction(mix(folded, 1.0 - folded, vec2(beyond.yx)));
}

// The weighted sum of a row's lookups about an axis.
vec3 tapped_radiance(sampler2D atlas, sampler2D taps, int row, vec3 axis)
{
  vec4 source = texelFetch(taps, ivec2(0, row), 0);
  mat3 frame = camera_frame(axis);
  vec3 radiance = vec3(0.0);
  int end = FIRST_TAP + int(source.w);
  for (int number = FIRST_TAP; number < end; number++) {
    vec4 tap = texelFetch(taps, ivec2(number, row), 0);
    radiance += tap.w * atlas_radiance(atlas, source.xyz, octahedral_uv(frame * tap.xyz));
  }
  return radiance;
}

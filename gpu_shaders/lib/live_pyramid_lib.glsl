// Twin of rsibr_addon/core/kinds/kernel_pyramid/live.py. A row of `taps` (see device/kinds/live_pyramid.py)
// tells of one map: where in the atlas the map lies that it is made of, as pyramid_lib.glsl has it, and the
// number of lookups; its own corner and width in texels, its border apart; its number in pyramid_lib.glsl, if
// it is a map by the normal, or 0, and the width of a ring; and the lookups.
#include "lib/directions_lib.glsl"
#include "lib/oren_nayar_lib.glsl"
#include "lib/pyramid_lib.glsl"
#include "lib/suns_lib.glsl"

const int FIRST_TAP = 3;

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

// What a map by the normal shows of suns; ring: the width of a ring, core/lobes/rings.py `ring`.
vec3 sunlit_by_normal(sampler2D lookups, int map, float ring, vec3 normal)
{
  Suns suns = suns_of(lookups);
  vec3 radiance = vec3(0.0);
  for (int sun = 0; sun < suns.count; sun++) {
    float cosine = max(dot(normal, sun_direction(lookups, sun)), 0.0);
    float stretched = ring * ring * (1.0 - cosine * cosine) + cosine * cosine;
    float shown = ring * ring * cosine / (PI * max(stretched * stretched, 1e-30));
    if (map == COSINE_MAP) {
      shown = cosine / PI;
    }
    else if (map == LEANING_MAP) {
      shown = cosine * leaning_albedo(cosine);
    }
    radiance += shown * sun_irradiance(lookups, sun);
  }
  return radiance;
}

// Twin of rsibr_addon/core/antialiased/averaging.py and strips.py: a table averaged over a pixel's
// footprint, [Miller1984] section 8.
#include "lib/equirect_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/summed_area_lib.glsl"

// Places of ways in `Averaging`; floats, as they come among others.
const float SUBDIVIDE = 0.0;
const float QUADRILATERAL = 1.0;

const float PART_ROWS = 2.0;
const int MOST_SUBDIVIDED = 16;
const float MOST_STRIPS = 32.0;
const float WHOLE = 1e-3;

// Width and height [texels] of boxes for smaller footprints.
const float SMALL = 1.001;

// Least width [texels] by which a strip's mean counts, so that one without any counts too.
const float LEAST_WIDTH = 1e-3;

// Beyond all u: an interval from here to its negative is empty.
const float BEYOND = 1e9;

// Boxes that hold parts of the footprint.
vec3 summed_mean(sampler2DArray table, vec3 unit, vec3 corners[4])
{
  vec2 size = vec2(textureSize(table, 0).xy - 1);
  vec3 across, up;
  footprint_sides(corners, across, up);
  ivec2 counts = sample_counts(across, up, PART_ROWS * PI / size.y);
  vec3 sum = vec3(0.0);
  for (int number = 0; number < counts.x * counts.y; number++) {
    vec2 low = vec2(number % counts.x, number / counts.x) / vec2(counts);
    vec2 high = low + 1.0 / vec2(counts);
    vec3 part[4] = vec3[4](within(corners, low),
                           within(corners, vec2(high.x, low.y)),
                           within(corners, high),
                           within(corners, vec2(low.x, high.y)));
    sum += box_mean(table, unit, footprint_box(part, size));
  }
  return sum / float(counts.x * counts.y);
}

// A lookup for each texel; boxes where that would be too many.
vec3 subdivided_mean(
    sampler2D bordered, sampler2DArray table, vec3 unit, vec3 direction, vec3 corners[4])
{
  float height = float(textureSize(bordered, 0).y - 2);
  vec3 across, up;
  footprint_sides(corners, across, up);
  float texel = PI / height * sqrt(max(length(direction.xy), 0.5 * PI / height));
  ivec2 counts = sample_counts(across, up, texel, MOST_SUBDIVIDED + 1);
  if (max(counts.x, counts.y) > MOST_SUBDIVIDED) {
    return summed_mean(table, unit, corners);
  }
  vec3 sum = vec3(0.0);
  for (int number = 0; number < counts.x * counts.y; number++) {
    sum += equirect_radiance(bordered, sample_direction(direction, across, up, counts, number));
  }
  return sum / float(counts.x * counts.y);
}

// The quadrilateral, as strips along the table's rows.
vec3 strip_mean(sampler2DArray table, vec3 unit, vec3 corners[4], vec4 whole)
{
  vec2 size = vec2(textureSize(table, 0).xy - 1);
  if (whole.z - whole.x >= 1.0) {
    return box_mean(table, unit, whole);
  }
  vec2 at[4];
  for (int i = 0; i < 4; i++) {
    at[i] = equirect_uv(corners[i]);
    float ahead = (i > 0) ? at[i].x - at[max(i - 1, 0)].x : 0.0;
    at[i].x -= roundEven(ahead);
  }
  float count = clamp(ceil((whole.w - whole.y) * size.y - WHOLE), 1.0, MOST_STRIPS);
  vec4 sum = vec4(0.0);
  for (float strip = 0.0; strip < count; strip += 1.0) {
    vec2 rows = mix(whole.yy, whole.ww, vec2(strip, strip + 1.0) / count);
    float middle = 0.5 * (rows.x + rows.y);
    vec2 crossed = vec2(BEYOND, -BEYOND);
    vec2 outer = vec2(BEYOND, -BEYOND);
    for (int i = 0; i < 4; i++) {
      vec2 from = at[i];
      vec2 to = at[(i + 1) % 4];
      if ((from.y <= middle) != (to.y <= middle)) {
        float x = from.x + (middle - from.y) / (to.y - from.y) * (to.x - from.x);
        crossed = vec2(min(crossed.x, x), max(crossed.y, x));
      }
      outer = vec2(min(outer.x, from.x), max(outer.y, from.x));
    }
    vec2 span = (crossed.x > crossed.y) ? outer : crossed;
    float extent = span.y - span.x;
    float half_width = 0.5 * max(extent, 1.0 / size.x);
    float left = 0.5 * (span.x + span.y) - half_width;
    left -= floor(left);
    vec4 box = vec4(left, rows.x, left + 2.0 * half_width, rows.y);
    float weight = max(extent, LEAST_WIDTH / size.x) * sin(PI * middle);
    sum += weight * vec4(box_mean(table, unit, box), 1.0);
  }
  return sum.rgb / sum.a;
}

// Mean radiance over a footprint; `averaging` is the place of the way in core/antialiased/averaging.py. Of
// less than a texel, the map interpolated in the footprint's middle: the same except for the solid angles of
// the rows, in a quarter of the time.
vec3 footprint_mean(sampler2D bordered,
                    sampler2DArray table,
                    vec3 unit,
                    vec3 direction,
                    vec3 corners[4],
                    float averaging)
{
  if (averaging == SUBDIVIDE) {
    return subdivided_mean(bordered, table, unit, direction, corners);
  }
  vec2 size = vec2(textureSize(table, 0).xy - 1);
  vec4 box = footprint_box(corners, size);
  vec2 extent = (box.zw - box.xy) * size;
  if (max(extent.x, extent.y) < SMALL) {
    return equirect_radiance(bordered, direction);
  }
  if (averaging == QUADRILATERAL) {
    return strip_mean(table, unit, corners, box);
  }
  return summed_mean(table, unit, corners);
}

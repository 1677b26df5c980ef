// Twin of rsibr_addon/core/antialiased/summed_area.py, and of the box in footprint.py:
// [Miller1984] section 8.3.
// The table is a texture array of three layers (see device/summed_area.py): the sums' lowest 21 bits, the
// next and the highest, as whole numbers. Sums and differences of four such numbers are whole and below
// 2^24, so single precision holds them exactly, in whatever order a compiler takes them.
#include "lib/equirect_lib.glsl"

const float DIGIT = 2097152.0;  // 2^21

// u and v of the box's lower left and upper right corners; u of the right one may lie beyond the seam.
vec4 footprint_box(vec3 corners[4], vec2 size)
{
  vec2 uv[4] = vec2[4](equirect_uv(corners[0]),
                       equirect_uv(corners[1]),
                       equirect_uv(corners[2]),
                       equirect_uv(corners[3]));
  vec2 low = uv[0];
  vec2 high = uv[0];
  float u = uv[0].x;
  float mean_v = 0.25 * uv[0].y;
  for (int i = 1; i < 4; i++) {
    float ahead = uv[i].x - uv[i - 1].x;
    u += ahead - roundEven(ahead);
    low = min(low, vec2(u, uv[i].y));
    high = max(high, vec2(u, uv[i].y));
    mean_v += 0.25 * uv[i].y;
  }
  float last = uv[0].x - uv[3].x;
  // A turn around a pole: the box goes all around it.
  if (abs(u + last - roundEven(last) - uv[0].x) > 0.5) {
    low = vec2(0.0, (mean_v > 0.5) ? low.y : 0.0);
    high = vec2(1.0, (mean_v > 0.5) ? 1.0 : high.y);
  }
  vec2 missing = 0.5 * max(1.0 / size - (high - low), 0.0);
  low -= missing;
  high += missing;
  float turn = floor(low.x);
  return vec4(low.x - turn, max(low.y, 0.0), high.x - turn, min(high.y, 1.0));
}

// An interval in three parts: its first texel, the texels that it holds whole, its last texel.
void cut(float low, float high, int last_edge, out ivec4 edges, out vec3 weights)
{
  float first = floor(low);
  float last = floor(high);
  bool several = last > first;
  edges = min(ivec4(first, first + 1.0, last, last + 1.0), last_edge);
  weights = vec3(min(high, first + 1.0) - low, several ? 1.0 : 0.0, several ? high - last : 0.0);
}

// A direction within a footprint, from 0 to 1 along its sides.
vec3 within(vec3 corners[4], vec2 place)
{
  return mix(mix(corners[0], corners[1], place.x), mix(corners[3], corners[2], place.x), place.y);
}

// One digit of a sum below and left of a texel's corner, columns counted on into a second turn.
vec3 digit_at(sampler2DArray table, int column, int row, int digit)
{
  int width = textureSize(table, 0).x - 1;
  if (column <= width) {
    return texelFetch(table, ivec3(column, row, digit), 0).rgb;
  }
  return texelFetch(table, ivec3(column - width, row, digit), 0).rgb +
         texelFetch(table, ivec3(width, row, digit), 0).rgb;
}

// Mean radiance over a rectangle of the table; `unit` is the unit of the sums. The box is split into nine
// where it cuts texels: each block is an exact sum and has a weight that is not negative.
vec3 box_mean(sampler2DArray table, vec3 unit, vec4 box)
{
  ivec2 size = textureSize(table, 0).xy - 1;
  ivec4 columns, rows;
  vec3 column_weights, row_weights;
  cut(box.x * float(size.x), box.z * float(size.x), 2 * size.x, columns, column_weights);
  cut(box.y * float(size.y), box.w * float(size.y), size.y, rows, row_weights);
  vec3 power = vec3(0.0);
  vec3 below[9];
  for (int j = 0; j < 4; j++) {
    vec3 here[9];
    for (int digit = 0; digit < 3; digit++) {
      vec3 left = digit_at(table, columns[0], rows[j], digit);
      for (int i = 0; i < 3; i++) {
        vec3 right = digit_at(table, columns[i + 1], rows[j], digit);
        here[3 * i + digit] = right - left;
        left = right;
      }
    }
    for (int i = 0; i < 3 && j > 0; i++) {
      vec3 low = here[3 * i] - below[3 * i];
      vec3 middle = here[3 * i + 1] - below[3 * i + 1];
      vec3 high = here[3 * i + 2] - below[3 * i + 2];
      power += row_weights[j - 1] * column_weights[i] * ((high * DIGIT + middle) * DIGIT + low);
    }
    below = here;
  }
  // Differences of cosines, as products.
  vec3 from = vec3(rows.xyz) * (PI / float(size.y));
  vec3 to = vec3(rows.yzw) * (PI / float(size.y));
  vec3 bands = 2.0 * sin(0.5 * (from + to)) * sin(0.5 * (to - from));
  float turn = dot(column_weights, vec3(columns.yzw - columns.xyz)) * (2.0 * PI / float(size.x));
  return power * unit / (turn * dot(row_weights, bands));
}

// Twin of rsibr_addon/core/kinds/live_environment.py and core/kinds/mip_chain/texture_space.py: [Kautz2004]
// sections 4.2, 5.1. A strip holds six faces side by side; the atlas, mips in borders, is that of
// mip_chain_lib.glsl. Solid angles: a square for each mip, from the bottom up, at the left.
#include "lib/cube_map_lib.glsl"
#include "lib/irradiance_lib.glsl"

// A coefficient's share of one row of a face.
vec3 harmonics_of_row(sampler2D strip, sampler2D solid_angles, int index, int face, int row)
{
  int size = textureSize(strip, 0).y;
  vec3 sum = vec3(0.0);
  for (int column = 0; column < size; column++) {
    vec3 direction = cube_direction((vec2(column, row) + 0.5) / float(size), face);
    float weight = real_harmonic(index, direction) * texelFetch(solid_angles, ivec2(column, row), 0).r;
    sum += weight * texelFetch(strip, ivec2(face * size + column, row), 0).rgb;
  }
  return sum;
}

// One of the coefficients: the sum over the rows of all faces.
vec3 harmonics_of_rows(sampler2D rows, int index)
{
  vec3 sum = vec3(0.0);
  for (int row = 0; row < textureSize(rows, 0).y; row++) {
    sum += texelFetch(rows, ivec2(index, row), 0).rgb;
  }
  return sum;
}

// Texel (-1 ... size) of a face of a strip within its borders; the mean of three where faces meet.
vec3 bordered_texel(sampler2D strip, ivec2 texel, int face, int size)
{
  ivec3 place = cube_wrap(texel, face, size);
  if (place.z >= 0) {
    return texelFetch(strip, ivec2(place.z * size + place.x, place.y), 0).rgb;
  }
  ivec2 inner = clamp(texel, 0, size - 1);
  ivec3 beside = cube_wrap(ivec2(texel.x, inner.y), face, size);
  ivec3 above = cube_wrap(ivec2(inner.x, texel.y), face, size);
  vec3 sum = texelFetch(strip, ivec2(face * size + inner.x, inner.y), 0).rgb;
  sum += texelFetch(strip, ivec2(beside.z * size + beside.x, beside.y), 0).rgb;
  sum += texelFetch(strip, ivec2(above.z * size + above.x, above.y), 0).rgb;
  return sum / 3.0;
}

// Where the atlas holds texel (0, 0) of a face of a mip.
ivec2 atlas_corner(int first_size, int mip, int face)
{
  int size = first_size >> mip;
  return ivec2(face * (size + 2), 2 * (first_size - size + mip)) + 1;
}

// Texel of the mip after `mip`: the mean of two by two.
vec3 box_halved(sampler2D atlas, int first_size, int mip, int face, ivec2 texel)
{
  ivec2 corner = atlas_corner(first_size, mip, face) + 2 * texel;
  vec3 sum = texelFetch(atlas, corner, 0).rgb + texelFetch(atlas, corner + ivec2(1, 0), 0).rgb;
  sum += texelFetch(atlas, corner + ivec2(0, 1), 0).rgb + texelFetch(atlas, corner + ivec2(1, 1), 0).rgb;
  return 0.25 * sum;
}

// The mean of four by four, weighted 1 3 3 1 both ways and by solid angle. A texel beyond an edge is as large
// as its mirror image within it.
vec3 tent_halved(sampler2D atlas, sampler2D solid_angles, int first_size, int mip, int face, ivec2 texel)
{
  int size = first_size >> mip;
  ivec2 corner = atlas_corner(first_size, mip, face);
  vec4 sum = vec4(0.0);
  for (int j = -1; j < 3; j++) {
    for (int i = -1; i < 3; i++) {
      ivec2 tap = 2 * texel + ivec2(i, j);
      ivec2 within = clamp(tap, 0, size - 1) + ivec2(0, 2 * (first_size - size));
      float weight = texelFetch(solid_angles, within, 0).r;
      weight *= ((i == 0 || i == 1) ? 3.0 : 1.0) * ((j == 0 || j == 1) ? 3.0 : 1.0);
      sum += weight * vec4(texelFetch(atlas, corner + tap, 0).rgb, 1.0);
    }
  }
  return sum.rgb / sum.a;
}

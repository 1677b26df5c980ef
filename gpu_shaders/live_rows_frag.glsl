// Each row's share of the coefficients: a column for each coefficient, the rows of six faces.
#include "lib/live_environment_lib.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int size = textureSize(strip, 0).y;
  texel = vec4(harmonics_of_row(strip, solid_angles, pixel.x, pixel.y / size, pixel.y % size), 1.0);
}

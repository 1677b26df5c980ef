// The coefficients of the irradiance, from the rows' shares of those of radiance.
#include "lib/live_environment_lib.glsl"

void main()
{
  int index = int(gl_FragCoord.x);
  float zonal = cosine_coefficient(int(sqrt(float(index) + 0.5)));
  texel = vec4(zonal * harmonics_of_rows(rows, index), 1.0);
}

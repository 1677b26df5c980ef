// Twin of rsibr_addon/core/filtering/irradiance.py.
#include "lib/directions_lib.glsl"

// [Ramamoorthi2001] Eq. 12: a quadratic form of the normal for each channel, `irradiance_matrix`.
vec3 irradiance(mat4 red, mat4 green, mat4 blue, vec3 normal)
{
  vec4 n = vec4(normal, 1.0);
  return vec3(dot(n, red * n), dot(n, green * n), dot(n, blue * n));
}

// One of the nine real harmonics of degree 2, in the order of `real_harmonics`: [Ramamoorthi2001] Eq. 3.
float real_harmonic(int index, vec3 d)
{
  if (index == 0) {
    return 0.28209479;
  }
  if (index < 4) {
    return 0.48860251 * ((index == 1) ? d.y : (index == 2) ? d.z : d.x);
  }
  if (index == 6) {
    return 0.31539157 * (3.0 * d.z * d.z - 1.0);
  }
  if (index == 8) {
    return 0.54627422 * (d.x * d.x - d.y * d.y);
  }
  return 1.09254843 * ((index == 4) ? d.x * d.y : (index == 5) ? d.y * d.z : d.x * d.z);
}

// Irradiance from nine coefficients, the texels of a row: [Ramamoorthi2001] Eq. 7, [Kautz2004] Eq. 12.
vec3 irradiance_from_harmonics(sampler2D coefficients, vec3 normal)
{
  vec3 sum = vec3(0.0);
  for (int index = 0; index < 9; index++) {
    float zonal = (index == 0) ? PI : (index < 4) ? 2.0 * PI / 3.0 : 0.25 * PI;
    sum += zonal * real_harmonic(index, normal) * texelFetch(coefficients, ivec2(index, 0), 0).rgb;
  }
  return sum;
}

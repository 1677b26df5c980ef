// Twin of rsibr_addon/core/filtering/irradiance.py.
#include "lib/directions_lib.glsl"

// Degree of the harmonics whose coefficients are the texels of a row.
int harmonics_degree(sampler2D coefficients)
{
  return int(sqrt(float(textureSize(coefficients, 0).x)) + 0.5) - 1;
}

// From degree l - 1 to l of harmonics of one order m < l: `values` are those of degrees l - 2 and l - 1, `a`
// is the factor of the step before, 1 of the first.
void next_degree(int l, int m, float z, inout vec2 values, inout float a)
{
  float step = sqrt(float(4 * l * l - 1) / float(l * l - m * m));
  values = vec2(values.y, step * (z * values.y - values.x / a));
  a = step;
}

// From order m to m + 1: of the harmonic of equal degree and order, and of (x + i y)^m.
void next_order(int m, vec3 d, inout float sectoral, inout vec2 power)
{
  sectoral *= sqrt(float(2 * m + 3) / float(2 * m + 2));
  power = vec2(power.x * d.x - power.y * d.y, power.x * d.y + power.y * d.x);
}

const float FIRST_HARMONIC = 0.28209479;
const float SQRT_2 = 1.41421356;

// One of the real harmonics, in the order of `real_harmonics`.
float real_harmonic(int index, vec3 d)
{
  int degree = int(sqrt(float(index) + 0.5));
  int signed_order = index - degree * (degree + 1);
  int order = abs(signed_order);
  float sectoral = FIRST_HARMONIC;
  vec2 power = vec2(1.0, 0.0);
  for (int m = 0; m < order; m++) {
    next_order(m, d, sectoral, power);
  }
  vec2 values = vec2(0.0, sectoral);
  float a = 1.0;
  for (int l = order + 1; l <= degree; l++) {
    next_degree(l, order, d.z, values, a);
  }
  float around = (order == 0) ? 1.0 : SQRT_2 * ((signed_order > 0) ? power.x : power.y);
  return values.y * around;
}

// Zonal coefficient of the cosine lobe: [Ramamoorthi2001] Eq. 8.
float cosine_coefficient(int degree)
{
  if (degree < 2) {
    return (degree == 0) ? PI : 2.0 * PI / 3.0;
  }
  if ((degree & 1) == 1) {
    return 0.0;
  }
  float coefficient = 0.25 * PI;
  for (int l = 2; l < degree; l += 2) {
    coefficient *= -float(l - 1) / float(l + 4);
  }
  return coefficient;
}

// Irradiance from its coefficients (`irradiance_coefficients`), the texels of a row: [Kautz2004] Eq. 12, of
// any degree. Those of odd degrees above 1 are 0.
vec3 irradiance(sampler2D coefficients, vec3 normal)
{
  int degree = harmonics_degree(coefficients);
  vec3 sum = vec3(0.0);
  float sectoral = FIRST_HARMONIC;
  vec2 power = vec2(1.0, 0.0);
  for (int m = 0; m <= degree; m++) {
    vec2 values = vec2(0.0, sectoral);
    float a = 1.0;
    for (int l = m; l <= degree; l++) {
      if (l > m) {
        next_degree(l, m, normal.z, values, a);
      }
      if (l > 1 && (l & 1) == 1) {
        continue;
      }
      int middle = l * (l + 1);
      if (m == 0) {
        sum += values.y * texelFetch(coefficients, ivec2(middle, 0), 0).rgb;
      }
      else {
        vec3 even = texelFetch(coefficients, ivec2(middle + m, 0), 0).rgb;
        vec3 odd = texelFetch(coefficients, ivec2(middle - m, 0), 0).rgb;
        sum += SQRT_2 * values.y * (power.x * even + power.y * odd);
      }
    }
    next_order(m, normal, sectoral, power);
  }
  return sum;
}

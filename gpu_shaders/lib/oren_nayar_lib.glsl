// Twin of rsibr_addon/core/brdf/oren_nayar.py: [Fujii2012], [Portsmouth2025].
#include "lib/directions_lib.glsl"

// 1 - PI a is this times b: 1 less a number near 1 would leave nothing of single precision.
const float LOST_BY_LEANING = PI / 2.0 - 2.0 / 3.0;

// a and b.
vec2 fujii_coefficients(float roughness)
{
  float a = 1.0 / (PI + roughness * LOST_BY_LEANING);
  return vec2(a, roughness * a);
}

float leaning_albedo(float n_dot_v)
{
  float cosine = clamp(n_dot_v, 1e-6, 1.0);
  float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
  // acos of drivers is good to four digits only
  float albedo = sine * (atan(sine, cosine) - 2.0 / 3.0 - sine * cosine);
  // (1 - sine^3) / cosine, without the difference of nearly equal numbers at grazing
  return albedo + 2.0 / 3.0 * sine * cosine * (1.0 + sine + sine * sine) / (1.0 + sine);
}

vec3 bounces(vec3 color, float roughness, float n_dot_v)
{
  vec3 facet = clamp(color, 0.0, 1.0);
  float b = fujii_coefficients(roughness).y;
  float mean_leaning = (2.0 * PI - 5.6) / 3.0;
  float mean_lost = b * (LOST_BY_LEANING - mean_leaning);
  // Lost over mean lost, of which b is a factor both; where b is 0, nothing is lost of what is multiplied
  float share = (LOST_BY_LEANING - leaning_albedo(n_dot_v)) / (LOST_BY_LEANING - mean_leaning);
  return facet * facet * (share * (1.0 - mean_lost) / PI) / (1.0 - facet * mean_lost);
}

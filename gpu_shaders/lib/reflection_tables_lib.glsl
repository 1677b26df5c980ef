// Twin of rsibr_addon/core/kinds/reflection_tables/shading.py: [Miller1984] sections 3, 7 and 9.
#include "lib/equirect_lib.glsl"
#include "lib/averaging_lib.glsl"

// Rows of the weights, in the order of core/kinds/reflection_tables/tables.py `Role`.
#define TABLE_DIFFUSE 0
#define TABLE_SPECULAR 1
#define TABLE_COAT 2
#define TABLE_RETRO 3
#define TABLE_REFRACTION 4
#define TABLES 5

vec3 table_weight(sampler2D weights, int role, float cosine)
{
  return textureLod(weights, vec2(cosine, (float(role) + 0.5) / float(TABLES)), 0.0).rgb;
}

// Weight times table, times factors: 0 where the table is missing or not shown.
vec3 weighted_table(vec3 factor, sampler2D table, sampler2D weights, int role, float cosine, vec3 direction)
{
  if (factor == vec3(0.0)) {
    return vec3(0.0);
  }
  return factor * table_weight(weights, role, cosine) * equirect_radiance(table, direction);
}

// The same for a table that is averaged over a pixel's footprint (see averaging_lib.glsl).
vec3 weighted_mean(vec3 factor,
                   sampler2D table,
                   sampler2DArray sums,
                   vec3 unit,
                   sampler2D weights,
                   int role,
                   float cosine,
                   vec3 direction,
                   vec3 corners[4],
                   float averaging)
{
  if (factor == vec3(0.0)) {
    return vec3(0.0);
  }
  return factor * table_weight(weights, role, cosine) *
         footprint_mean(table, sums, unit, direction, corners, averaging);
}

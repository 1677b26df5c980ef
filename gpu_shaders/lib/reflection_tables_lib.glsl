// Twin of rsibr_addon/core/shading/reflection_tables.py: [Miller1984] sections 3, 7 and 9.
#include "lib/equirect_lib.glsl"

// Rows of the weights, in the order of core/reflection_tables.py `Role`.
#define TABLE_DIFFUSE 0
#define TABLE_SPECULAR 1
#define TABLE_COAT 2
#define TABLE_RETRO 3
#define TABLE_REFRACTION 4
#define TABLES 5

// Weight times table, or black where the table is not there or not to be shown.
vec3 weighted_table(float shown, sampler2D table, sampler2D weights, int role, float cosine, vec3 direction)
{
  if (shown < 0.5) {
    return vec3(0.0);
  }
  vec3 weight = textureLod(weights, vec2(cosine, (float(role) + 0.5) / float(TABLES)), 0.0).rgb;
  return weight * equirect_radiance(table, direction);
}

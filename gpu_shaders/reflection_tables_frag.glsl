// Twin of core/kinds/reflection_tables/shading.py `reflect_tables`.
#include "lib/directions_lib.glsl"
#include "lib/draw_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/reflection_tables_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  vec3 mirror_dir = reflect_dir(view_dir, unit_normal);
  vec3 refracted_dir = refract_dir(view_dir, unit_normal, tables.eta);
  float cosine = dot(unit_normal, view_dir);
  vec3 across, up, corners[4];
  pixel_sides(mirror_dir, 1.0, across, up);
  parallelogram(mirror_dir, across, up, corners);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  radiance.rgb += weighted_table(tables.diffuse, diffuse, weights, TABLE_DIFFUSE, cosine, unit_normal);
  radiance.rgb += weighted_table(tables.specular, specular, weights, TABLE_SPECULAR, cosine, mirror_dir);
  radiance.rgb += weighted_table(tables.coat, coat, weights, TABLE_COAT, cosine, mirror_dir);
  radiance.rgb += weighted_mean(tables.specular_mean,
                                specular,
                                specular_sums,
                                tables.specular_unit.rgb,
                                weights,
                                TABLE_SPECULAR,
                                cosine,
                                mirror_dir,
                                corners);
  radiance.rgb += weighted_mean(tables.coat_mean,
                                coat,
                                coat_sums,
                                tables.coat_unit.rgb,
                                weights,
                                TABLE_COAT,
                                cosine,
                                mirror_dir,
                                corners);
  radiance.rgb += weighted_table(tables.retro, retro, weights, TABLE_RETRO, cosine, view_dir);
  radiance.rgb += weighted_table(
      tables.refraction, refraction, weights, TABLE_REFRACTION, cosine, refracted_dir);
}

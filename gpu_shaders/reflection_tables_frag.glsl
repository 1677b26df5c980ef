// Twin of core/kinds/reflection_tables/shading.py `reflect_tables`.
#include "lib/directions_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/reflection_tables_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 mirror_dir = reflect_dir(seen.view_dir, seen.mirror_normal);
  float eta = seen.outside ? tables.eta : 1.0 / tables.eta;
  vec3 refracted_dir = refract_dir(seen.view_dir, seen.mirror_normal, eta);
  float cosine = dot(seen.mirror_normal, seen.view_dir);
  vec3 across, up, corners[4];
  pixel_sides(mirror_dir, 1.0, across, up);
  parallelogram(mirror_dir, across, up, corners);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  radiance.rgb += weighted_table(tables.diffuse, diffuse, weights, TABLE_DIFFUSE, cosine, seen.normal);
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
  radiance.rgb += weighted_table(tables.retro, retro, weights, TABLE_RETRO, cosine, seen.view_dir);
  radiance.rgb += weighted_table(
      tables.refraction, refraction, weights, TABLE_REFRACTION, cosine, refracted_dir);
}

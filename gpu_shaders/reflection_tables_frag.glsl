// Twin of core/kinds/reflection_tables/shading.py `reflect_tables`.
#include "lib/directions_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/reflection_tables_lib.glsl"
#include "lib/sides_lib.glsl"

// The region of directions over which a pixel's lookup is averaged.
void footprint(vec3 direction, out vec3 corners[4])
{
  vec3 across, up;
  pixel_sides(direction, tables.antialiased, across, up);
  parallelogram(direction, across, up, corners);
}

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 mirror_dir = reflect_dir(seen.view_dir, seen.mirror_normal);
  float eta = seen.outside ? tables.eta : 1.0 / tables.eta;
  vec3 refracted_dir = refract_dir(seen.view_dir, seen.mirror_normal, eta);
  float cosine = dot(seen.mirror_normal, seen.view_dir);
  vec3 mirrored[4], refracted[4], seen_back[4];
  footprint(mirror_dir, mirrored);
  footprint(refracted_dir, refracted);
  footprint(seen.view_dir, seen_back);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  radiance.rgb += weighted_table(tables.diffuse.rgb, diffuse, weights, TABLE_DIFFUSE, cosine, seen.normal);
  radiance.rgb += tables.added.rgb * table_weight(weights, TABLE_DIFFUSE, cosine);
  radiance.rgb += weighted_mean(tables.specular.rgb,
                                specular,
                                specular_sums,
                                tables.specular_unit.rgb,
                                weights,
                                TABLE_SPECULAR,
                                cosine,
                                mirror_dir,
                                mirrored,
                                tables.averaging);
  radiance.rgb += weighted_mean(tables.coat.rgb,
                                coat,
                                coat_sums,
                                tables.coat_unit.rgb,
                                weights,
                                TABLE_COAT,
                                cosine,
                                mirror_dir,
                                mirrored,
                                tables.averaging);
  radiance.rgb += weighted_mean(tables.retro.rgb,
                                retro,
                                retro_sums,
                                tables.retro_unit.rgb,
                                weights,
                                TABLE_RETRO,
                                cosine,
                                seen.view_dir,
                                seen_back,
                                tables.averaging);
  radiance.rgb += weighted_mean(tables.refraction.rgb,
                                refraction,
                                refraction_sums,
                                tables.refraction_unit.rgb,
                                weights,
                                TABLE_REFRACTION,
                                cosine,
                                refracted_dir,
                                refracted,
                                tables.averaging);
}

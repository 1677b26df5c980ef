// Twin of core/kinds/reflection_tables/shading.py `reflect_tables`. A program for map sets without a table
// may define that, as NO_COAT: drivers compute both ways of a branch.
#include "lib/directions_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/reflection_tables_lib.glsl"
#include "lib/seen_samples_lib.glsl"

vec3 refracted(Seen seen)
{
  return refract_dir(seen.view_dir, seen.mirror_normal, seen.outside ? tables.eta : 1.0 / tables.eta);
}

// The region of directions over which a pixel's lookup is averaged.
void footprint(vec3 direction, vec3 beside, vec3 above, out vec3 corners[4])
{
  vec3 across, up;
  sample_sides(direction, beside, above, tables.antialiased, across, up);
  parallelogram(direction, across, up, corners);
}

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  vec3 mirror_dir = mirrored(seen);
  vec3 refracted_dir = refracted(seen);
  float cosine = dot(seen.mirror_normal, seen.view_dir);
  vec3 mirrored_from[4], refracted_from[4], seen_back[4];
  footprint(mirror_dir, mirrored(beside), mirrored(above), mirrored_from);
  footprint(refracted_dir, refracted(beside), refracted(above), refracted_from);
  footprint(seen.view_dir, beside.view_dir, above.view_dir, seen_back);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  radiance.rgb += weighted_table(tables.diffuse.rgb, diffuse, weights, TABLE_DIFFUSE, cosine, seen.normal);
  radiance.rgb += tables.added.rgb * table_weight(weights, TABLE_DIFFUSE, cosine);
#ifndef NO_SPECULAR
  radiance.rgb += weighted_mean(tables.specular.rgb,
                                specular,
                                specular_sums,
                                tables.specular_unit.rgb,
                                weights,
                                TABLE_SPECULAR,
                                cosine,
                                mirror_dir,
                                mirrored_from,
                                tables.averaging);
#endif
#ifndef NO_COAT
  radiance.rgb += weighted_mean(tables.coat.rgb,
                                coat,
                                coat_sums,
                                tables.coat_unit.rgb,
                                weights,
                                TABLE_COAT,
                                cosine,
                                mirror_dir,
                                mirrored_from,
                                tables.averaging);
#endif
#ifndef NO_RETRO
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
#endif
#ifndef NO_REFRACTION
  radiance.rgb += weighted_mean(tables.refraction.rgb,
                                refraction,
                                refraction_sums,
                                tables.refraction_unit.rgb,
                                weights,
                                TABLE_REFRACTION,
                                cosine,
                                refracted_dir,
                                refracted_from,
                                tables.averaging);
#endif
}

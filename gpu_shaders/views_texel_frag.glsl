// Twin of core/shading.py `destination_by_texel`: the destination map, warped per texel.
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = mat3(blend.frame) * normal_from_uv(map_uv);
  vec3 view_dir = blend.frame[2].xyz;
  ivec3 sources = ivec3(blend.sources.xyz);
  vec3 source_dirs[3] = vec3[3](blend.source_dirs[0].xyz, blend.source_dirs[1].xyz, blend.source_dirs[2].xyz);
  bool split = mode.split > 0.5;
  vec3 weights = blend.weights.xyz;
  by_normal.rgb = warped_by_normal(views, split, unit_normal, view_dir, sources, source_dirs, weights);
  by_mirror.rgb = warped_by_mirror(views, split, unit_normal, view_dir, sources, source_dirs, weights);
  by_normal.a = by_mirror.a = 1.0;
}

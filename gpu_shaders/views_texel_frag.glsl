// Twin of core/shading `destination_by_texel`: the destination map, warped per texel.
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = mat3(blend.frame) * normal_from_uv(map_uv);
  vec3 view_dir = blend.frame[2].xyz;
  ivec3 sources = ivec3(blend.sources.xyz);
  vec3 source_dirs[3] = vec3[3](blend.source_dirs[0].xyz, blend.source_dirs[1].xyz, blend.source_dirs[2].xyz);
  vec3 weights = blend.weights.xyz;
  int warping = int(mode.warping);
  by_normal = by_mirror = vec4(1.0);
  by_normal.rgb = warp_and_blend(
      views, albedo, warping, WARP_NORMAL, unit_normal, view_dir, sources, source_dirs, weights);
  by_mirror.rgb = warp_and_blend(
      views, albedo, warping, WARP_MIRROR, unit_normal, view_dir, sources, source_dirs, weights);
}

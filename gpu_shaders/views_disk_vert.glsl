// Twin of core/shading `destination_by_mesh`, first half: at each vertex of the tessellated disk,
// where every source shows its central direction, and at which cosine.
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = mat3(blend.frame) * normal_from_uv(0.5 * position + 0.5);
  vec3 view_dir = blend.frame[2].xyz;
  normal_seen_0 = seen_by(WARP_NORMAL, unit_normal, view_dir, blend.source_dirs[0].xyz);
  normal_seen_1 = seen_by(WARP_NORMAL, unit_normal, view_dir, blend.source_dirs[1].xyz);
  normal_seen_2 = seen_by(WARP_NORMAL, unit_normal, view_dir, blend.source_dirs[2].xyz);
  mirror_seen_0 = seen_by(WARP_MIRROR, unit_normal, view_dir, blend.source_dirs[0].xyz);
  mirror_seen_1 = seen_by(WARP_MIRROR, unit_normal, view_dir, blend.source_dirs[1].xyz);
  mirror_seen_2 = seen_by(WARP_MIRROR, unit_normal, view_dir, blend.source_dirs[2].xyz);
  gl_Position = vec4(position, 0.0, 1.0);
}

// Twin of core/shading.py `destination_by_mesh`, first half: at each vertex of the tessellated disk,
// where every source shows its central direction (xy) and the confidence in it (z).
#include "lib/reflection_warp_lib.glsl"

vec3 seen_by(int warp, vec3 unit_normal, vec3 view_dir, vec3 source_dir)
{
  return vec3(source_uv(warp, unit_normal, view_dir, camera_frame(source_dir)),
              confidence(warp, unit_normal, view_dir, source_dir));
}

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

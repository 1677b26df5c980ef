// Twin of core/kinds `destination_by_mesh`, first half: at each vertex of the tessellated disk,
// where every source shows its central direction, and at which cosine. The sources are the same at all.
#include "lib/draw_lib.glsl"
#include "lib/geodesic_lib.glsl"
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 view_dir = object_view_direction(draw.eye, draw.model, draw.turn);
  vec3 unit_normal = camera_frame(view_dir) * normal_from_uv(0.5 * position + 0.5);
  sources = find_triangle(sphere, int(mode.last_level), view_dir);
  mat3 corners = geodesic_corners(sphere, sources);
  weights = barycentric_weights(view_dir, corners[0], corners[1], corners[2]);
  int fading = int(mode.fading);
  normal_seen_0 = seen_by(fading, WARP_NORMAL, unit_normal, view_dir, corners[0]);
  normal_seen_1 = seen_by(fading, WARP_NORMAL, unit_normal, view_dir, corners[1]);
  normal_seen_2 = seen_by(fading, WARP_NORMAL, unit_normal, view_dir, corners[2]);
  mirror_seen_0 = seen_by(fading, WARP_MIRROR, unit_normal, view_dir, corners[0]);
  mirror_seen_1 = seen_by(fading, WARP_MIRROR, unit_normal, view_dir, corners[1]);
  mirror_seen_2 = seen_by(fading, WARP_MIRROR, unit_normal, view_dir, corners[2]);
  gl_Position = vec4(position, 0.0, 1.0);
}

// Twin of core/kinds `destination_by_texel`: the destination map, warped per texel.
#include "lib/geodesic_lib.glsl"
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = camera_frame(view_dir) * normal_from_uv(map_uv);
  mat3 corners = geodesic_corners(sphere, sources);
  int warping = int(mode.warping);
  int fading = int(mode.fading);
  by_normal = by_mirror = vec4(1.0);
  by_normal.rgb = warp_and_blend(
      views, albedo, warping, fading, WARP_NORMAL, unit_normal, view_dir, sources, corners, weights);
  by_mirror.rgb = warp_and_blend(
      views, albedo, warping, fading, WARP_MIRROR, unit_normal, view_dir, sources, corners, weights);
}

// Twin of core/shading `views_fragment`: every fragment finds and blends its own three views.
#include "lib/draw_lib.glsl"
#include "lib/geodesic_lib.glsl"
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  ivec3 sources = find_triangle(sphere, int(mode.last_level), view_dir);
  mat3 corners = geodesic_corners(sphere, sources);
  vec3 weights = barycentric_weights(view_dir, corners[0], corners[1], corners[2]);
  int warping = int(mode.warping);
  float cosine = dot(unit_normal, view_dir);
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  for (int warp = WARP_NORMAL; warp <= WARP_MIRROR; warp++) {
    radiance.rgb += albedo_at(albedo, warping, warp, cosine) *
                    warp_and_blend(
                        views, albedo, warping, warp, unit_normal, view_dir, sources, corners, weights);
  }
}

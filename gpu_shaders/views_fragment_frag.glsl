// Twin of core/kinds `views_fragment`: every fragment finds and blends its own three views.
#include "lib/draw_lib.glsl"
#include "lib/footprint_lib.glsl"
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
  vec3 by_normal = warp_and_blend(
      views, albedo, warping, WARP_NORMAL, unit_normal, view_dir, sources, corners, weights);
  vec3 mirror_dir = reflect_dir(view_dir, unit_normal);
  vec3 across, up;
  pixel_sides(mirror_dir, mode.antialiased, across, up);
  float texel_angle = sphere_map_texel_angle(float(textureSize(views, 0).x));
  ivec2 counts = sample_counts(across, up, texel_angle);
  int lookups = counts.x * counts.y;
  vec3 by_mirror = vec3(0.0);
  for (int number = 0; number < lookups; number++) {
    vec3 normal = mirror_normal(view_dir, sample_direction(mirror_dir, across, up, counts, number));
    by_mirror += warp_and_blend(
        views, albedo, warping, WARP_MIRROR, normal, view_dir, sources, corners, weights);
  }
  radiance.rgb = by_normal * albedo_at(albedo, warping, WARP_NORMAL, cosine) +
                 by_mirror / float(lookups) * albedo_at(albedo, warping, WARP_MIRROR, cosine);
  radiance.a = 1.0;
}

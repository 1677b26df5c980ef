// Twin of core/kinds `views_fragment`: every fragment finds and blends its own three views.
#include "lib/footprint_lib.glsl"
#include "lib/geodesic_lib.glsl"
#include "lib/radiance_views_lib.glsl"
#include "lib/seen_samples_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  ivec3 sources = find_triangle(sphere, int(mode.last_level), seen.view_dir);
  mat3 corners = geodesic_corners(sphere, sources);
  vec3 weights = barycentric_weights(seen.view_dir, corners[0], corners[1], corners[2]);
  int warping = int(mode.warping);
  int fading = int(mode.fading);
  vec3 by_normal = warp_and_blend(
      views, albedo, warping, fading, WARP_NORMAL, seen.normal, seen.view_dir, sources, corners, weights);
  vec3 mirror_dir = mirrored(seen);
  vec3 across, up;
  sample_sides(mirror_dir, mirrored(beside), mirrored(above), mode.antialiased, across, up);
  float texel_angle = sphere_map_texel_angle(float(textureSize(views, 0).x));
  ivec2 counts = sample_counts(across, up, texel_angle);
  int lookups = counts.x * counts.y;
  vec3 by_mirror = vec3(0.0);
  for (int number = 0; number < lookups; number++) {
    vec3 normal = mirror_normal(seen.view_dir, sample_direction(mirror_dir, across, up, counts, number));
    by_mirror += warp_and_blend(
        views, albedo, warping, fading, WARP_MIRROR, normal, seen.view_dir, sources, corners, weights);
  }
  float diffuse_cosine = dot(seen.normal, seen.view_dir);
  float glossy_cosine = dot(seen.mirror_normal, seen.view_dir);
  radiance.rgb = by_normal * albedo_at(albedo, warping, WARP_NORMAL, diffuse_cosine) +
                 by_mirror / float(lookups) * albedo_at(albedo, warping, WARP_MIRROR, glossy_cosine);
  radiance.a = 1.0;
}

// Twin of core/kinds `destination_lookup`: shades from the sphere map of one view.
#include "lib/footprint_lib.glsl"
#include "lib/radiance_views_lib.glsl"
#include "lib/seen_samples_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  mat3 frame = camera_frame(object_view_direction(draw.eye, draw.model, draw.turn));
  vec2 normal_uv = uv_from_normal(seen.normal * frame);
  vec3 mirror_dir = mirrored(seen);
  vec3 across, up;
  sample_sides(mirror_dir, mirrored(beside), mirrored(above), mode.antialiased, across, up);
  float texel_angle = sphere_map_texel_angle(float(textureSize(by_mirror, 0).x));
  ivec2 counts = sample_counts(across, up, texel_angle);
  int lookups = counts.x * counts.y;
  vec3 glossy = vec3(0.0);
  for (int number = 0; number < lookups; number++) {
    vec3 direction = sample_direction(mirror_dir, across, up, counts, number);
    glossy += textureLod(by_mirror, uv_from_direction(direction * frame), 0.0).rgb;
  }
  int warping = int(mode.warping);
  float diffuse_cosine = dot(seen.normal, seen.view_dir);
  float glossy_cosine = dot(seen.mirror_normal, seen.view_dir);
  radiance.rgb = textureLod(by_normal, normal_uv, 0.0).rgb *
                     albedo_at(albedo, warping, WARP_NORMAL, diffuse_cosine) +
                 glossy / float(lookups) * albedo_at(albedo, warping, WARP_MIRROR, glossy_cosine);
  radiance.a = 1.0;
}

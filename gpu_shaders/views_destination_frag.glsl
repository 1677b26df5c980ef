// Twin of core/shading `destination_lookup`: shades from the sphere map of one view.
#include "lib/draw_lib.glsl"
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  mat3 frame = camera_frame(destination.view_dir.xyz);
  vec2 normal_uv = uv_from_normal(unit_normal * frame);
  vec2 mirror_uv = uv_from_direction(reflect_dir(view_dir, unit_normal) * frame);
  int warping = int(mode.warping);
  float cosine = dot(unit_normal, view_dir);
  radiance.rgb = textureLod(by_normal, normal_uv, 0.0).rgb * albedo_at(albedo, warping, WARP_NORMAL, cosine) +
                 textureLod(by_mirror, mirror_uv, 0.0).rgb * albedo_at(albedo, warping, WARP_MIRROR, cosine);
  radiance.a = 1.0;
}

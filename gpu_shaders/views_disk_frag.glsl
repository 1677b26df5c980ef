// Twin of core/kinds `destination_by_mesh`, second half: the sources blended at the places
// interpolated over the disk.
#include "lib/radiance_views_lib.glsl"

void main()
{
  int warping = int(mode.warping);
  vec4 normal_seen[3] = vec4[3](normal_seen_0, normal_seen_1, normal_seen_2);
  vec4 mirror_seen[3] = vec4[3](mirror_seen_0, mirror_seen_1, mirror_seen_2);
  by_normal = by_mirror = vec4(1.0);
  by_normal.rgb = blend_sources(views, albedo, warping, WARP_NORMAL, sources, normal_seen, weights);
  by_mirror.rgb = blend_sources(views, albedo, warping, WARP_MIRROR, sources, mirror_seen, weights);
}

// Twin of core/shading.py `destination_by_mesh`, second half: the sources blended at the places
// interpolated over the disk.
#include "lib/radiance_views_lib.glsl"

void main()
{
  bool split = mode.split > 0.5;
  vec3 seen[3] = vec3[3](mirror_seen_0, mirror_seen_1, mirror_seen_2);
  vec3 shares = blend_shares(blend.weights.xyz, vec3(seen[0].z, seen[1].z, seen[2].z));
  by_mirror = vec4(0.0, 0.0, 0.0, 1.0);
  for (int i = 0; i < 3; i++) {
    int source = int(blend.sources[i]);
    by_mirror.rgb += shares[i] * (split ? glossy_radiance(views, source, seen[i].xy) :
                                          combined_radiance(views, source, seen[i].xy));
  }
  by_normal = vec4(0.0, 0.0, 0.0, 1.0);
  if (split) {
    seen = vec3[3](normal_seen_0, normal_seen_1, normal_seen_2);
    shares = blend_shares(blend.weights.xyz, vec3(seen[0].z, seen[1].z, seen[2].z));
    for (int i = 0; i < 3; i++) {
      by_normal.rgb += shares[i] * diffuse_radiance(views, int(blend.sources[i]), seen[i].xy);
    }
  }
}

// Twin of core/shading.py `views_fragment`: every fragment finds and blends its own three views.
#include "lib/draw_lib.glsl"
#include "lib/geodesic_lib.glsl"
#include "lib/radiance_views_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  ivec3 sources = find_triangle(sphere, int(mode.last_level), view_dir);
  vec3 source_dirs[3];
  for (int i = 0; i < 3; i++) {
    source_dirs[i] = geodesic_vertex(sphere, sources[i]);
  }
  vec3 weights = barycentric_weights(view_dir, source_dirs[0], source_dirs[1], source_dirs[2]);
  bool split = mode.split > 0.5;
  radiance.rgb = warped_by_normal(views, split, unit_normal, view_dir, sources, source_dirs, weights) +
                 warped_by_mirror(views, split, unit_normal, view_dir, sources, source_dirs, weights);
  radiance.a = 1.0;
}

// Twin of core/kinds `destination_by_texel`, what it does once: one triangle that holds the whole map,
// the view, and the three sources around it.
#include "lib/draw_lib.glsl"
#include "lib/geodesic_lib.glsl"

void main()
{
  view_dir = object_view_direction(draw.eye, draw.model, draw.turn);
  sources = find_triangle(sphere, int(mode.last_level), view_dir);
  mat3 corners = geodesic_corners(sphere, sources);
  weights = barycentric_weights(view_dir, corners[0], corners[1], corners[2]);
  map_uv = 0.5 * position + 0.5;
  gl_Position = vec4(position, 0.0, 1.0);
}

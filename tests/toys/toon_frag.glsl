// Twin of tests/toys/toon_mode.py `toon_radiance`.
#include "lib/draw_lib.glsl"

void main()
{
  float cosine = dot(normalize(world_normal), view_direction(draw.eye, world_position));
  radiance = vec4(look.gain.x * ((cosine > look.edge.x) ? look.middle.rgb : look.rim.rgb), 1.0);
}

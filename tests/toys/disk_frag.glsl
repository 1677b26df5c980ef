// Twin of tests/toys/disk_core.py `disk_radiance`.
#include "lib/draw_lib.glsl"

void main()
{
  float cosine = clamp(dot(normalize(world_normal), view_direction(draw.eye, world_position)), 0.0, 1.0);
  radiance = vec4(look.gain.x * mix(look.rim.rgb, look.middle.rgb, cosine), 1.0);
}

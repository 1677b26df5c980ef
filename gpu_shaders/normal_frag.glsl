// The unit normal of a surface, on the side that is seen.
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  radiance = vec4(seen.normal, 1.0);
}

// Shades every normal with the radiance of an exactly lit sphere, by the normal that lobe stacks have.
#include "lib/lit_sphere_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  radiance = vec4(lit_sphere_radiance(rings, mat3(sphere.frame), seen.mirror_normal), 1.0);
}

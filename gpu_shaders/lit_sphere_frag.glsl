// Shades every normal with the radiance of an exactly lit sphere.
#include "lib/lit_sphere_lib.glsl"

void main()
{
  radiance = vec4(lit_sphere_radiance(rings, mat3(sphere.frame), normalize(world_normal)), 1.0);
}

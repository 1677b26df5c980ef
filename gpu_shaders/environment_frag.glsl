// Twin of core/kinds/environment.py `mirrored_environment`.
#include "lib/averaging_lib.glsl"
#include "lib/directions_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 mirror_dir = reflect_dir(seen.view_dir, seen.mirror_normal);
  vec3 fresnel = fresnel_schlick(clamp(dot(seen.mirror_normal, seen.view_dir), 0.0, 1.0), look.f0.rgb);
  vec3 across, up, corners[4];
  pixel_sides(mirror_dir, 1.0, across, up);
  parallelogram(mirror_dir, across, up, corners);
  vec3 light = (look.antialiased > 0.5) ?
                   footprint_mean(environment, sums, look.unit.rgb, mirror_dir, corners, look.averaging) :
                   equirect_radiance(environment, mirror_dir);
  radiance = vec4(fresnel * light, 1.0);
}

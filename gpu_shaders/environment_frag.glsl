// Twin of core/kinds/environment.py `mirrored_environment`.
#include "lib/directions_lib.glsl"
#include "lib/draw_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/summed_area_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  vec3 mirror_dir = reflect_dir(view_dir, unit_normal);
  vec3 fresnel = fresnel_schlick(clamp(dot(unit_normal, view_dir), 0.0, 1.0), look.f0.rgb);
  vec3 across, up, corners[4];
  pixel_sides(mirror_dir, 1.0, across, up);
  parallelogram(mirror_dir, across, up, corners);
  vec3 light = (look.antialiased > 0.5) ?
                   footprint_mean(environment, sums, look.unit.rgb, mirror_dir, corners) :
                   equirect_radiance(environment, mirror_dir);
  radiance = vec4(fresnel * light, 1.0);
}

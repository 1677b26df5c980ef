// Twin of core/kinds/environment.py `mirrored_environment`.
#include "lib/averaging_lib.glsl"
#include "lib/directions_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/seen_samples_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  vec3 mirror_dir = mirrored(seen);
  vec3 fresnel = fresnel_schlick(clamp(dot(seen.mirror_normal, seen.view_dir), 0.0, 1.0), look.f0.rgb);
  vec3 across, up, corners[4];
  sample_sides(mirror_dir, mirrored(beside), mirrored(above), 1.0, across, up);
  parallelogram(mirror_dir, across, up, corners);
  vec3 light = (look.antialiased > 0.5) ?
                   footprint_mean(environment, sums, look.unit.rgb, mirror_dir, corners, look.averaging) :
                   equirect_radiance(environment, mirror_dir);
  radiance = vec4(fresnel * light, 1.0);
}

// Twin of core/kinds/mip_chain/shading.py `mip_chain_radiance`: [Kautz2004] Eq. 8 in one pass.
#include "lib/directions_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/irradiance_lib.glsl"
#include "lib/mip_chain_lib.glsl"
#include "lib/near_diffuse_lib.glsl"
#include "lib/probes_lib.glsl"
#include "lib/seen_samples_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  vec3 fresnel = fresnel_schlick(clamp(dot(seen.mirror_normal, seen.view_dir), 0.0, 1.0), look.f0.rgb);
  int probes = int(look.captured_at.w);
  float rows = float(textureSize(atlas, 0).y / (probes + 1));
  float total = 0.0;
  for (int number = 0; number < probes; number++) {
    total += probe_weight(probe_place(places, number), seen.position);
  }
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  // The light of no room, and then that of each
  for (int number = 0; number <= probes; number++) {
    Place place = Place(look.captured_at.xyz, look.room.w, look.room.xyz, look.middle.xyz, 1.0);
    float share = max(1.0 - total, 0.0);
    if (number > 0) {
      place = probe_place(places, number - 1);
      share = probe_weight(place, seen.position) / max(total, 1.0);
    }
    if (share > 0.0) {
      float bottom = float(number) * rows;
      vec3 diffuse = (place.room < 0.5) ?
                         max(irradiance(harmonics, seen.normal), 0.0) / PI :
                         near_diffuse(atlas, bottom, look.middle.w, place, seen.position, seen.normal);
      vec3 mirror_dir = near_direction(place, seen.position, mirrored(seen));
      vec3 across, up;
      sample_sides(mirror_dir,
                   near_direction(place, beside.position, mirrored(beside)),
                   near_direction(place, above.position, mirrored(above)),
                   look.antialiased,
                   across,
                   up);
      vec3 glossy = glossy_mean(
          atlas, bottom, mirror_dir, across, up, look.level, look.last_level, look.clamped > 0.5);
      radiance.rgb += share * mix(look.kd.rgb * diffuse, glossy, fresnel);
    }
  }
}

// Twin of core/kinds/mip_chain/shading.py `mip_chain_radiance`: [Kautz2004] Eq. 8 in one pass.
#include "lib/directions_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/irradiance_lib.glsl"
#include "lib/mip_chain_lib.glsl"
#include "lib/near_diffuse_lib.glsl"
#include "lib/probes_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 fresnel = fresnel_schlick(clamp(dot(seen.mirror_normal, seen.view_dir), 0.0, 1.0), look.f0.rgb);
  vec3 reflected = reflect_dir(seen.view_dir, seen.mirror_normal);
  int probes = int(look.captured_at.w);
  float rows = float(textureSize(atlas, 0).y / (probes + 1));
  float total = 0.0;
  for (int number = 0; number < probes; number++) {
    total += probe_weight(probe_place(places, number), world_position);
  }
  radiance = vec4(0.0, 0.0, 0.0, 1.0);
  // The light of no room, and then that of each
  for (int number = 0; number <= probes; number++) {
    Place place = Place(look.captured_at.xyz, look.room.w, look.room.xyz, look.middle.xyz, 1.0);
    float share = max(1.0 - total, 0.0);
    if (number > 0) {
      place = probe_place(places, number - 1);
      share = probe_weight(place, world_position) / max(total, 1.0);
    }
    vec3 mirror_dir = near_direction(place, world_position, reflected);
    // Differences to neighbours, which all have to take
    vec3 across, up;
    pixel_sides(mirror_dir, look.antialiased, across, up);
    if (share > 0.0) {
      float bottom = float(number) * rows;
      vec3 diffuse = (place.room < 0.5) ?
                         max(irradiance(harmonics, seen.normal), 0.0) / PI :
                         near_diffuse(atlas, bottom, look.middle.w, place, world_position, seen.normal);
      vec3 glossy = glossy_mean(
          atlas, bottom, mirror_dir, across, up, look.level, look.last_level, look.clamped > 0.5);
      radiance.rgb += share * mix(look.kd.rgb * diffuse, glossy, fresnel);
    }
  }
}

// Twin of core/kinds/mip_chain/shading.py `mip_chain_radiance`: [Kautz2004] Eq. 8 in one pass.
#include "lib/directions_lib.glsl"
#include "lib/fresnel_lib.glsl"
#include "lib/irradiance_lib.glsl"
#include "lib/mip_chain_lib.glsl"
#include "lib/near_diffuse_lib.glsl"
#include "lib/near_room_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 fresnel = fresnel_schlick(clamp(dot(seen.mirror_normal, seen.view_dir), 0.0, 1.0), look.f0.rgb);
  vec3 position = world_position - look.captured_at.xyz;
  vec3 diffuse = look.kd.rgb;
  if (look.room.w < 0.5) {
    diffuse *= max(irradiance(harmonics, seen.normal), 0.0) / PI;
  }
  else {
    diffuse *= near_diffuse(
        atlas, look.middle.w, position, seen.normal, look.room.w, look.room.xyz, look.middle.xyz);
  }
  vec3 mirror_dir = near_direction(position,
                                   reflect_dir(seen.view_dir, seen.mirror_normal),
                                   look.room.w,
                                   look.room.xyz,
                                   look.middle.xyz);
  vec3 across, up;
  pixel_sides(mirror_dir, look.antialiased, across, up);
  vec3 glossy = glossy_mean(
      atlas, mirror_dir, across, up, look.level, look.last_level, look.clamped > 0.5);
  radiance = vec4(mix(diffuse, glossy, fresnel), 1.0);
}

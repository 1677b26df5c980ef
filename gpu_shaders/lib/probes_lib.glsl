// Twin of rsibr_addon/core/kinds/mip_chain/probes.py: where maps were captured, and their rooms.
#include "lib/near_room_lib.glsl"

struct Place {
  vec3 captured_at;
  float room;
  vec3 half_size;
  // Relative to captured_at
  vec3 middle;
  float blend;
};

// One of device/kinds/mip_chain.py `place_texels`.
Place probe_place(sampler2D places, int number)
{
  vec4 room = texelFetch(places, ivec2(0, number), 0);
  vec4 middle = texelFetch(places, ivec2(1, number), 0);
  return Place(texelFetch(places, ivec2(2, number), 0).xyz, room.w, room.xyz, middle.xyz, middle.w);
}

// The same as in near_room_lib.glsl, of a point in world coordinates.
vec3 near_direction(Place place, vec3 position, vec3 direction)
{
  return near_direction(
      position - place.captured_at, direction, place.room, place.half_size, place.middle);
}

// 1 inside the room, 0 from `blend` beyond its border on.
float probe_weight(Place place, vec3 position)
{
  vec3 from_middle = position - place.captured_at - place.middle;
  return clamp(1.0 - outside_distance(from_middle, place.room, place.half_size) / place.blend, 0.0, 1.0);
}

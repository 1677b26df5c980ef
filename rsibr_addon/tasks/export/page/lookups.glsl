// Bilinear lookups with exact weights: graphics cards round them to 8 bits, which shows where light is sharp or kernels
// cancel each other, and not all phones interpolate floats.

struct Square {
  ivec2 low;
  ivec2 high;
  vec2 share;
};

// The four texels around a place.
Square square_around(vec2 place, ivec2 size)
{
  vec2 texel = place * vec2(size) - 0.5;
  ivec2 low = ivec2(floor(texel));
  return Square(clamp(low, ivec2(0), size - 1), clamp(low + 1, ivec2(0), size - 1), fract(texel));
}

vec4 mixed(vec4 low_low, vec4 high_low, vec4 low_high, vec4 high_high, vec2 share)
{
  return mix(mix(low_low, high_low, share.x), mix(low_high, high_high, share.x), share.y);
}

vec4 looked_up(sampler2D map, vec2 place)
{
  Square around = square_around(place, textureSize(map, 0));
  return mixed(texelFetch(map, around.low, 0),
               texelFetch(map, ivec2(around.high.x, around.low.y), 0),
               texelFetch(map, ivec2(around.low.x, around.high.y), 0),
               texelFetch(map, around.high, 0),
               around.share);
}

vec4 looked_up(sampler2DArray map, vec3 place)
{
  Square around = square_around(place.xy, textureSize(map, 0).xy);
  int layer = int(place.z + 0.5);
  return mixed(texelFetch(map, ivec3(around.low, layer), 0),
               texelFetch(map, ivec3(around.high.x, around.low.y, layer), 0),
               texelFetch(map, ivec3(around.low.x, around.high.y, layer), 0),
               texelFetch(map, ivec3(around.high, layer), 0),
               around.share);
}

vec4 level_at(sampler3D map, Square around, int level)
{
  return mixed(texelFetch(map, ivec3(around.low, level), 0),
               texelFetch(map, ivec3(around.high.x, around.low.y, level), 0),
               texelFetch(map, ivec3(around.low.x, around.high.y, level), 0),
               texelFetch(map, ivec3(around.high, level), 0),
               around.share);
}

vec4 looked_up(sampler3D map, vec3 place)
{
  ivec3 size = textureSize(map, 0);
  Square around = square_around(place.xy, size.xy);
  float level = place.z * float(size.z) - 0.5;
  ivec2 levels = clamp(int(floor(level)) + ivec2(0, 1), 0, size.z - 1);
  return mix(level_at(map, around, levels.x), level_at(map, around, levels.y), fract(level));
}

// Twin of rsibr_addon/core/kinds/mip_chain/shading.py: [Kautz2004] section 4.2. The atlas (see
// device/kinds/mip_chain.py) holds a row of six faces for each mip, the first at the bottom, and around every
// face a border of one texel: the neighbouring texels on the cube. Chains of several rooms lie one above the
// other; `bottom` is the row where one begins.
#include "lib/cube_map_lib.glsl"
#include "lib/footprint_lib.glsl"

// Bilinear within a face, and with its border unless clamped.
vec3 mip_radiance(sampler2D atlas, float bottom, int mip, vec3 place, bool clamped)
{
  vec2 atlas_size = vec2(textureSize(atlas, 0));
  float first_size = atlas_size.x / 6.0 - 2.0;
  float size = exp2(-float(mip)) * first_size;
  vec2 texel = place.xy * size;
  if (clamped) {
    texel = clamp(texel, 0.5, size - 0.5);
  }
  vec2 corner = vec2(place.z * (size + 2.0), bottom + 2.0 * (first_size - size + float(mip))) + 1.0;
  return textureLod(atlas, (corner + texel) / atlas_size, 0.0).rgb;
}

// Linear between mips; level lies in [0, mips - 1].
vec3 glossy_radiance(sampler2D atlas, float bottom, vec3 direction, float level, bool clamped)
{
  vec3 place = cube_place(direction);
  float mip = floor(level);
  vec3 near = mip_radiance(atlas, bottom, int(mip), place, clamped);
  if (level == mip) {
    return near;
  }
  return mix(near, mip_radiance(atlas, bottom, int(mip) + 1, place, clamped), level - mip);
}

// The mean over what a pixel reflects, whose sides are across and up: lookups a texel apart, or as far as
// the texels of the mip that they are taken from.
vec3 glossy_mean(sampler2D atlas,
                 float bottom,
                 vec3 mirror_dir,
                 vec3 across,
                 vec3 up,
                 float level,
                 float last_level,
                 bool clamped)
{
  float first_size = float(textureSize(atlas, 0).x) / 6.0 - 2.0;
  float texel = exp2(level) * cube_texel_angle(mirror_dir, first_size);
  ivec2 counts = sample_counts(across, up, texel);
  vec2 apart = vec2(length(across), length(up)) / vec2(counts);
  float missed = log2(max(max(apart.x, apart.y) / texel, 1.0));
  int lookups = counts.x * counts.y;
  vec3 sum = vec3(0.0);
  for (int number = 0; number < lookups; number++) {
    vec3 direction = sample_direction(mirror_dir, across, up, counts, number);
    sum += glossy_radiance(atlas, bottom, direction, min(level + missed, last_level), clamped);
  }
  return sum / float(lookups);
}

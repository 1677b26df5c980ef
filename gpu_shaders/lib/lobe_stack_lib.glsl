// Twin of rsibr_addon/core/kinds/lobe_stack/shading.py: [Kautz2000] section 5.3.
// The texture `elevations` (see device/kinds/lobe_stack.py) has a column for each sampled elevation. Row 0
// holds their cosines; then come, for each lobe, a row of scales and one of each tap's tilt, turn and weight.
// Light with suns has more rows. The first texel of each holds a sun's direction, or its irradiance, or
// a kernel's concentration and peak. Then come, for each lobe, rows of the weights of its kernels.
// The 3D texture `maps` holds, for each lobe, and for each sheet of its maps, a slice for each elevation, or
// one for all. Around every sheet lies a border of one texel: what continues it on the sphere.
#include "lib/directions_lib.glsl"
#include "lib/dual_paraboloid_lib.glsl"
#include "lib/footprint_lib.glsl"
#include "lib/lobe_axes_lib.glsl"
#include "lib/octahedral_lib.glsl"

// Suns that maps lack.
struct LobeSuns {
  int count;
  // Kernels that show them.
  int kernels;
  // Row of `elevations` with the first.
  int row;
  // 1 less the cosine from which on each is not seen.
  float reach;
  // A cone, with the cosine of its half angle: outside, none is seen.
  vec4 cone;
};

#define LAYOUT_DUAL_PARABOLOID 0
#define LAYOUT_OCTAHEDRAL 1

// Where a view lies among the elevations: number of the one below, and share of the next.
vec2 elevation_at(sampler2D elevations, float mu)
{
  int last = textureSize(elevations, 0).x - 1;
  int below = 0;
  while (below < last - 1 && mu >= texelFetch(elevations, ivec2(below + 1, 0), 0).r) {
    below++;
  }
  if (last == 0) {
    return vec2(0.0);
  }
  float low = texelFetch(elevations, ivec2(below, 0), 0).r;
  float high = texelFetch(elevations, ivec2(below + 1, 0), 0).r;
  return vec2(float(below), clamp((mu - low) / (high - low), 0.0, 1.0));
}

// A row of the table, linear between two elevations.
vec3 elevation_value(sampler2D elevations, int row, vec2 elevation)
{
  int below = int(elevation.x);
  int above = min(below + 1, textureSize(elevations, 0).x - 1);
  return mix(texelFetch(elevations, ivec2(below, row), 0).rgb,
             texelFetch(elevations, ivec2(above, row), 0).rgb,
             elevation.y);
}

// u and v on a sheet, and the sheet's number.
vec3 stack_place(int layout_number, float size, vec3 direction)
{
  if (layout_number == LAYOUT_OCTAHEDRAL) {
    return vec3(octahedral_uv(direction), 0.0);
  }
  // The centres of the outermost texels lie on the hemisphere's rim.
  return dual_paraboloid_place(direction, (size - 1.0) / size);
}

// A lobe's map along an axis, linear between texels and between elevations.
vec3 map_radiance(sampler3D maps, int layout_number, int slices, int lobe, vec3 axis, float elevation)
{
  vec3 texture_size = vec3(textureSize(maps, 0));
  float size = texture_size.x - 2.0;
  vec3 place = stack_place(layout_number, size, axis);
  float sheets = (layout_number == LAYOUT_OCTAHEDRAL) ? 1.0 : 2.0;
  float slice = min(elevation, float(slices) - 1.0);
  float first = (float(lobe) * sheets + place.z) * float(slices);
  vec3 texel = vec3(place.xy * size + 1.0, first + slice + 0.5);
  return textureLod(maps, texel / texture_size, 0.0).rgb;
}

// Distance between texels around a unit direction, in radians.
float stack_texel_angle(int layout_number, float size, vec3 direction)
{
  vec3 part = abs(direction);
  if (layout_number == LAYOUT_OCTAHEDRAL) {
    float sum = part.x + part.y + part.z;
    return 2.0 / size * sum * sqrt(sum);
  }
  return 2.0 / (size - 1.0) * (1.0 + part.y);
}

// What a lobe's kernels about an axis make of suns, which its map lacks.
vec3 lobe_sunlight(sampler2D elevations, LobeSuns suns, int lobe, vec3 axis, vec2 elevation)
{
  if (suns.count == 0 || dot(axis, suns.cone.xyz) < suns.cone.w) {
    return vec3(0.0);
  }
  int first_kernel = suns.row + 2 * suns.count;
  int first_weight = first_kernel + suns.kernels * (1 + lobe);
  vec3 radiance = vec3(0.0);
  for (int sun = 0; sun < suns.count; sun++) {
    vec3 between = axis - texelFetch(elevations, ivec2(0, suns.row + 2 * sun), 0).xyz;
    // 1 less the cosine, without the loss of digits
    float apart = 0.5 * dot(between, between);
    if (apart >= suns.reach) {
      continue;
    }
    vec3 profile = vec3(0.0);
    for (int number = 0; number < suns.kernels; number++) {
      vec4 kernel = texelFetch(elevations, ivec2(0, first_kernel + number), 0);
      profile += elevation_value(elevations, first_weight + number, elevation) * kernel.y *
                 exp(-kernel.x * apart);
    }
    radiance += profile * texelFetch(elevations, ivec2(0, suns.row + 2 * sun + 1), 0).rgb;
  }
  return radiance;
}

// The mean over what a pixel reflects, whose sides are across and up; normal: `Seen.mirror_normal`.
vec3 stack_radiance(sampler3D maps,
                    sampler2D elevations,
                    int layout_number,
                    int lobes,
                    int taps,
                    int slices,
                    LobeSuns suns,
                    vec3 normal,
                    vec3 view_dir,
                    vec3 across,
                    vec3 up)
{
  vec3 mirror_dir = reflect_dir(view_dir, normal);
  vec2 elevation = elevation_at(elevations, dot(normal, view_dir));
  float size = float(textureSize(maps, 0).x) - 2.0;
  ivec2 counts = sample_counts(across, up, stack_texel_angle(layout_number, size, mirror_dir));
  int lookups = counts.x * counts.y;
  vec3 mean = vec3(0.0);
  for (int number = 0; number < lookups; number++) {
    vec3 direction = sample_direction(mirror_dir, across, up, counts, number);
    vec3 radiance = vec3(0.0);
    for (int lobe = 0; lobe < lobes; lobe++) {
      int row = 1 + lobe * (taps + 1);
      vec3 scale = elevation_value(elevations, row, elevation);
      for (int tap = 1; tap <= taps; tap++) {
        vec3 lookup = elevation_value(elevations, row + tap, elevation);
        if (lookup.z == 0.0) {
          // Lobes of one tap, among others of several
          continue;
        }
        vec3 axis = lobe_axis(normal, direction, lookup.xy);
        vec3 filtered =
            map_radiance(maps, layout_number, slices, lobe, axis, elevation.x + elevation.y) +
            lobe_sunlight(elevations, suns, lobe, axis, elevation);
        radiance += lookup.z * scale * filtered;
      }
    }
    // Signed lobes may have a negative sum.
    mean += max(radiance, 0.0) / float(lookups);
  }
  return mean;
}

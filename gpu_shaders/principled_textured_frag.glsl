// Twin of rsibr_addon/core/materials and of core/kinds/kernel_pyramid/shading.py `principled_radiance`: a
// material whose inputs are affine in the texels of textures. The uniform block `material` and the textures
// `image_0` to `image_7` are those of device/textured_materials.py.
//
// A program for materials without bumps may define UNBUMPED: see principled_lib.glsl. Any may define
// TEXTURES, how many it samples at most, and FIRST_COVERED, the first of them that is multiplied by alpha
// before it is interpolated.
#include "lib/footprint_lib.glsl"
#include "lib/principled_radiance_lib.glsl"
#include "lib/shading_normal_lib.glsl"
#include "lib/sides_lib.glsl"
#include "lib/spread_lib.glsl"

#ifdef UNBUMPED
const bool MAY_BE_BUMPED = false;
#else
const bool MAY_BE_BUMPED = true;
#endif
#ifndef TEXTURES
#define TEXTURES 8
#endif
#ifndef FIRST_COVERED
#define FIRST_COVERED 0
#endif

// Bits of what changes the normal.
const int NORMAL_MAPPED = 1;
const int BUMPED = 2;
const int COAT_LIKE_BASE = 4;
const int COAT_NORMAL_MAPPED = 8;

// Places of inputs among the numbers, in the order of device/textured_materials.py `INPUTS`.
const int BASE_COLOR = 0;
const int METALLIC = 3;
const int ROUGHNESS = 4;
const int IOR = 5;
const int SPECULAR_LEVEL = 6;
const int SPECULAR_TINT = 7;
const int DIFFUSE_ROUGHNESS = 10;
const int COAT_WEIGHT = 11;
const int COAT_ROUGHNESS = 12;
const int COAT_IOR = 13;
const int COAT_TINT = 14;
const int EMISSION_COLOR = 17;
const int EMISSION_STRENGTH = 20;
const int ALPHA = 21;
const int SHEEN_WEIGHT = 22;
const int SHEEN_ROUGHNESS = 23;
const int SHEEN_TINT = 24;
const int NORMAL_COLOR = 27;
const int NORMAL_STRENGTH = 30;
const int BUMP_STRENGTH = 31;
const int BUMP_DISTANCE = 32;
const int COAT_NORMAL_COLOR = 33;
const int COAT_NORMAL_STRENGTH = 36;
const int NUMBERS = 40;

float numbers[NUMBERS];

// Where a texture is looked up; its lower left corner is (0, 0), its upper right one (1, 1).
vec2 texture_place(int number)
{
  vec4 first = material.mapping[2 * number];
  vec4 second = material.mapping[2 * number + 1];
  int uv_map = int(first.w);
  vec4 pair = (uv_map < 2) ? uv_01 : uv_23;
  vec3 uv = vec3((uv_map % 2 == 0) ? pair.xy : pair.zw, 1.0);
  // A UV map that the mesh does not have is 0 everywhere, as in Cycles
  uv.xy = (uv_map < 0) ? vec2(0.0) : uv.xy;
  return vec2(dot(first.xyz, uv), dot(second.xyz, uv));
}

// Four texels around a place: centres of the lower left and the upper right one, and the place between them.
struct Corners {
  vec2 near, far, share;
};

// The texels next to a place for a span of 1, else four that are a span apart, the place in their middle.
Corners corners_of(vec2 place, vec2 size, float span)
{
  vec2 texel = place * size - 0.5;
  vec2 low = (span > 1.0) ? texel - 0.5 * span : floor(texel);
  return Corners((low + 0.5) / size, (low + 0.5 + span) / size, (texel - low) / span);
}

// How many texels a pixel is wide, 1 at least.
float texels_across(vec2 right, vec2 above, vec2 size)
{
  return max(max(length(right * size), length(above * size)), 1.0);
}

vec4 times_alpha(vec4 texel)
{
  return vec4(texel.rgb * texel.a, texel.a);
}

// Degrees of Texture.covered, as device/textured_materials.py `material_rows` writes them.
const float COVERED = 1.0;
const float COVERED_AND_INTERPOLATED = 2.0;

// Level of an image itself. It has a name, as pages take a level of 0.0 for a map's, which does not repeat.
const float ALL_TEXELS = 0.0;

// An image's colour; times alpha before it is interpolated where it is covered, as by Cycles. From two texels
// a pixel on, these are mips' means.
vec4 texel_of(sampler2D image, int number)
{
  vec2 place = texture_place(number);
  float degree = material.mapping[2 * number + 1].w;
  if (number < FIRST_COVERED || degree < COVERED_AND_INTERPOLATED) {
    vec4 texel = texture(image, place);
    return (degree < COVERED) ? texel : times_alpha(texel);
  }
  vec2 size = vec2(textureSize(image, 0));
  vec2 right, above;
  pixel_sides(place, right, above);
  float level = log2(texels_across(right, above, size));
  Corners at = corners_of(place, size, 1.0);
  vec4 c00 = times_alpha(textureLod(image, at.near, ALL_TEXELS));
  vec4 c10 = times_alpha(textureLod(image, vec2(at.far.x, at.near.y), ALL_TEXELS));
  vec4 c01 = times_alpha(textureLod(image, vec2(at.near.x, at.far.y), ALL_TEXELS));
  vec4 c11 = times_alpha(textureLod(image, at.far, ALL_TEXELS));
  vec4 magnified = mix(mix(c00, c10, at.share.x), mix(c01, c11, at.share.x), at.share.y);
  vec4 mip = times_alpha(textureLod(image, place, max(level, 1.0)));
  return mix(magnified, mip, min(level, 1.0));
}

// Adds what a texture gives to the numbers that are affine in its texels.
void add_texels(int number, vec4 texel)
{
  vec4 range = material.ranges[number];
  // A range has one row at least; see principled_radiance_lib.glsl for why the test comes last
  int row = int(range.x);
  do {
    numbers[int(material.targets[row].x)] += dot(material.rows[row], texel);
  } while (++row < int(range.y));
}

// Makes the numbers of all inputs, of each texture in turn; `count` is the same for all fragments, so
// that derivatives exist.
void evaluate_inputs()
{
  // By fours: software drivers do not unroll loops of more than 32 rounds, and index each number at run time
  for (int row = 0; row < NUMBERS / 4; row++) {
    vec4 constants = material.constants[row];
    for (int column = 0; column < 4; column++) {
      numbers[4 * row + column] = constants[column];
    }
  }
  int count = int(material.counts.x);
  if (TEXTURES > 0 && count > 0) {
    add_texels(0, texel_of(image_0, 0));
  }
  if (TEXTURES > 1 && count > 1) {
    add_texels(1, texel_of(image_1, 1));
  }
  if (TEXTURES > 2 && count > 2) {
    add_texels(2, texel_of(image_2, 2));
  }
  if (TEXTURES > 3 && count > 3) {
    add_texels(3, texel_of(image_3, 3));
  }
  if (TEXTURES > 4 && count > 4) {
    add_texels(4, texel_of(image_4, 4));
  }
  if (TEXTURES > 5 && count > 5) {
    add_texels(5, texel_of(image_5, 5));
  }
  if (TEXTURES > 6 && count > 6) {
    add_texels(6, texel_of(image_6, 6));
  }
  if (TEXTURES > 7 && count > 7) {
    add_texels(7, texel_of(image_7, 7));
  }
}

vec3 color_of(int number)
{
  return vec3(numbers[number], numbers[number + 1], numbers[number + 2]);
}

// How much higher neighbours on the right and above are, by the slope of the first texture's texels.
vec2 height_rises()
{
  vec2 place = texture_place(0);
  vec2 size = vec2(textureSize(image_0, 0));
  vec2 right, above;
  pixel_sides(place, right, above);
  float span = texels_across(right, above, size);
  float level = log2(span);
  Corners at = corners_of(place, size, span);
  vec4 row = material.height;
  float h00 = dot(row, textureLod(image_0, at.near, level));
  float h10 = dot(row, textureLod(image_0, vec2(at.far.x, at.near.y), level));
  float h01 = dot(row, textureLod(image_0, vec2(at.near.x, at.far.y), level));
  float h11 = dot(row, textureLod(image_0, at.far, level));
  vec2 slope = vec2(mix(h10 - h00, h11 - h01, at.share.y), mix(h01 - h00, h11 - h10, at.share.x));
  slope *= size / span;
  return vec2(dot(slope, right), dot(slope, above));
}

// A unit normal of a normal map, in the map set's world.
vec3 world_mapped_normal(vec3 color, float strength)
{
  vec3 mapped = mapped_normal(color, strength, object_normal, object_tangent);
  return normalize(mat3(draw.turn) * transformed_normal(mat3(draw.model), mapped));
}

// The unit normal that the material is shaded with, in the map set's world.
vec3 shading_normal()
{
  int changes = int(material.counts.y);
  vec3 normal = normalize(world_normal);
  if ((changes & NORMAL_MAPPED) != 0) {
    normal = world_mapped_normal(color_of(NORMAL_COLOR), numbers[NORMAL_STRENGTH]);
  }
  if (MAY_BE_BUMPED && (changes & BUMPED) != 0) {
    vec3 right, above;
    pixel_sides(world_position, 1.0, right, above);
    // Steps near 1: squares of those of a close view would vanish in single precision
    float scale = 1.0 / max(max(length(right), length(above)), 1e-30);
    vec2 rises = scale * numbers[BUMP_DISTANCE] * height_rises();
    normal = bumped_normal(normal, scale * right, scale * above, rises, numbers[BUMP_STRENGTH]);
  }
  return normal;
}

// That of the coat: the surface's own where the material has none for it.
vec3 coat_shading_normal(vec3 normal)
{
  int changes = int(material.counts.y);
  if ((changes & COAT_LIKE_BASE) != 0) {
    return normal;
  }
  if ((changes & COAT_NORMAL_MAPPED) != 0) {
    return world_mapped_normal(color_of(COAT_NORMAL_COLOR), numbers[COAT_NORMAL_STRENGTH]);
  }
  return normalize(world_normal);
}

// Spread of the normals of a normal map within a pixel that holds several texels: its texture is one of the
// first two. What is magnified has texels that differ, but one normal everywhere.
float map_spread()
{
  int number = int(material.antialiasing.z);
  if (number < 0) {
    return 0.0;
  }
  ivec2 size = (number == 0) ? textureSize(image_0, 0) : textureSize(image_1, 0);
  vec2 right, above;
  pixel_sides(texture_place(number) * vec2(size), right, above);
  float level = log2(max(max(length(right), length(above)), 1.0));
  float strength = numbers[NORMAL_STRENGTH];
  vec3 mean = 2.0 * color_of(NORMAL_COLOR) - 1.0;
  return min(level, 1.0) * strength * strength * mean_spread(mean, material.antialiasing.y);
}

// Half a step of 8 bits: what covers less is not there and hides nothing, and what covers all but that is
// opaque.
const float LEAST_ALPHA = 0.5 / 255.0;

// Of what covers less, normals are not told, as by Cycles.
const float LEAST_SEEN = 0.5;

void main()
{
  evaluate_inputs();
  vec3 base_normal = shading_normal();
  Seen seen = seen_surface(draw.eye, draw.model, world_position, base_normal, gl_FrontFacing);
#ifdef NORMALS
  if (numbers[ALPHA] < LEAST_SEEN) {
    discard;
  }
  radiance = vec4(seen.normal, 1.0);
#else
  vec3 coat_normal = coat_shading_normal(base_normal);
  Seen seen_coat = seen_surface(draw.eye, draw.model, world_position, coat_normal, gl_FrontFacing);
  float antialiased = material.antialiasing.x;
  vec3 across, up;
  pixel_sides(seen.normal, antialiased, across, up);
  float spread = pixel_spread(across, up) + antialiased * map_spread();
  pixel_sides(seen_coat.normal, antialiased, across, up);
  float coat_spread = pixel_spread(across, up);
  float alpha = clamp(numbers[ALPHA], 0.0, 1.0);
#ifdef TRANSLUCENT
  // Behind all that needs neighbours
  if ((alpha > 1.0 - LEAST_ALPHA) != (whole > 0.0) || alpha < LEAST_ALPHA) {
    discard;
  }
#endif
  Surface surface = Surface(color_of(BASE_COLOR),
                            numbers[METALLIC],
                            widened_roughness(clamp(numbers[ROUGHNESS], 0.0, 1.0), spread),
                            numbers[IOR],
                            alpha,
                            clamp(numbers[DIFFUSE_ROUGHNESS], 0.0, 1.0),
                            numbers[SPECULAR_LEVEL],
                            color_of(SPECULAR_TINT),
                            numbers[COAT_WEIGHT],
                            widened_roughness(clamp(numbers[COAT_ROUGHNESS], 0.0, 1.0), coat_spread),
                            numbers[COAT_IOR],
                            color_of(COAT_TINT),
                            numbers[SHEEN_WEIGHT],
                            numbers[SHEEN_ROUGHNESS],
                            color_of(SHEEN_TINT),
                            emitted(color_of(EMISSION_COLOR) * numbers[EMISSION_STRENGTH], draw.strength));
  radiance.rgb = principled_radiance(atlas,
                                     lookups,
                                     ggx,
                                     leaning,
                                     albedos,
                                     rises,
                                     sheens,
                                     surface,
                                     seen.normal,
                                     normalize(seen.outside ? world_normal : -world_normal),
                                     seen.mirror_normal,
                                     seen_coat.mirror_normal,
                                     seen.view_dir);
  radiance.a = alpha;
#endif
}

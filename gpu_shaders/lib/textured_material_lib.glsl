// Twin of rsibr_addon/core/materials: the inputs of a material at a fragment, from its textures' texels. The
// uniform block `material` and the textures `image_0` to `image_7` are those of device/textured_materials.py.
#include "lib/directions_lib.glsl"
#include "lib/shading_normal_lib.glsl"

const int TEXTURES = 8;

// Bits of what changes the normal.
const int NORMAL_MAPPED = 1;
const int BUMPED = 2;

// Numbers of the block, in the order of device/textured_materials.py `NUMBERS`.
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
const int NORMAL_COLOR = 22;
const int NORMAL_STRENGTH = 25;
const int BUMP_HEIGHT = 26;
const int BUMP_STRENGTH = 27;
const int BUMP_DISTANCE = 28;

vec4 texels[TEXTURES];

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

// All textures that the material has, once each; `count` is the same for all fragments, so that derivatives exist.
void sample_textures()
{
  int count = int(material.counts.x);
  if (count > 0) {
    texels[0] = texture(image_0, texture_place(0));
  }
  if (count > 1) {
    texels[1] = texture(image_1, texture_place(1));
  }
  if (count > 2) {
    texels[2] = texture(image_2, texture_place(2));
  }
  if (count > 3) {
    texels[3] = texture(image_3, texture_place(3));
  }
  if (count > 4) {
    texels[4] = texture(image_4, texture_place(4));
  }
  if (count > 5) {
    texels[5] = texture(image_5, texture_place(5));
  }
  if (count > 6) {
    texels[6] = texture(image_6, texture_place(6));
  }
  if (count > 7) {
    texels[7] = texture(image_7, texture_place(7));
  }
}

float number_of(int row)
{
  vec4 added = material.constants[row];
  if (added.y < 0.0) {
    return added.x;
  }
  return added.x + dot(material.rows[row], texels[int(added.y)]);
}

vec3 color_of(int row)
{
  return vec3(number_of(row), number_of(row + 1), number_of(row + 2));
}

// How much higher a pixel's neighbours on the right and above are, by the slope of the first texture's texels: of
// the four around a point where that is magnified, else of four a texel of its mip apart.
vec2 height_rises()
{
  vec2 place = texture_place(0);
  vec2 size = vec2(textureSize(image_0, 0));
  vec2 right = dFdx(place);
  vec2 above = dFdy(place);
  float span = max(max(length(right * size), length(above * size)), 1.0);
  vec2 texel = place * size - 0.5;
  vec2 low = (span > 1.0) ? texel - 0.5 * span : floor(texel);
  vec2 share = (texel - low) / span;
  float level = log2(span);
  vec4 row = material.rows[BUMP_HEIGHT];
  vec2 near = (low + 0.5) / size;
  vec2 far = (low + 0.5 + span) / size;
  float h00 = dot(row, textureLod(image_0, near, level));
  float h10 = dot(row, textureLod(image_0, vec2(far.x, near.y), level));
  float h01 = dot(row, textureLod(image_0, vec2(near.x, far.y), level));
  float h11 = dot(row, textureLod(image_0, far, level));
  vec2 slope = vec2(mix(h10 - h00, h11 - h01, share.y), mix(h01 - h00, h11 - h10, share.x)) * size / span;
  return vec2(dot(slope, right), dot(slope, above));
}

// The unit normal that the material is shaded with, in the map set's world.
vec3 shading_normal()
{
  int changes = int(material.counts.y);
  vec3 normal = normalize(world_normal);
  if ((changes & NORMAL_MAPPED) != 0) {
    vec3 mapped = mapped_normal(
        color_of(NORMAL_COLOR), number_of(NORMAL_STRENGTH), object_normal, object_tangent);
    normal = normalize(mat3(draw.turn) * transformed_normal(mat3(draw.model), mapped));
  }
  if ((changes & BUMPED) != 0) {
    vec3 right = dFdx(world_position);
    vec3 above = dFdy(world_position);
    // Steps near 1: squares of those of a close view would vanish in single precision
    float scale = 1.0 / max(max(length(right), length(above)), 1e-30);
    vec2 rises = scale * number_of(BUMP_DISTANCE) * height_rises();
    normal = bumped_normal(normal, scale * right, scale * above, rises, number_of(BUMP_STRENGTH));
  }
  return normal;
}

// Twin of rsibr_addon/core/materials: the inputs of a material at a fragment, from its textures' texels. The
// uniform block `material` and the textures `image_0` to `image_7` are those of device/textured_materials.py.

const int TEXTURES = 8;

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

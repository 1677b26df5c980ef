// Twin of core/kinds/kernel_pyramid/shading.py `principled_radiance`, of a material whose inputs are textures:
// core/materials.
#include "lib/principled_radiance_lib.glsl"
#include "lib/sides_lib.glsl"
#include "lib/textured_material_lib.glsl"

void main()
{
  sample_textures();
  Seen seen = seen_surface(draw.eye, draw.model, world_position, shading_normal(), gl_FrontFacing);
  float alpha = clamp(number_of(ALPHA), 0.0, 1.0);
  Surface surface = Surface(color_of(BASE_COLOR),
                            number_of(METALLIC),
                            clamp(number_of(ROUGHNESS), 0.0, 1.0),
                            number_of(IOR),
                            alpha,
                            clamp(number_of(DIFFUSE_ROUGHNESS), 0.0, 1.0),
                            number_of(SPECULAR_LEVEL),
                            color_of(SPECULAR_TINT),
                            number_of(COAT_WEIGHT),
                            clamp(number_of(COAT_ROUGHNESS), 0.0, 1.0),
                            number_of(COAT_IOR),
                            color_of(COAT_TINT),
                            color_of(EMISSION_COLOR) * number_of(EMISSION_STRENGTH));
  radiance.rgb = principled_radiance(atlas,
                                     places,
                                     ggx,
                                     leaning,
                                     albedos,
                                     rises,
                                     surface,
                                     seen.normal,
                                     seen.mirror_normal,
                                     seen.view_dir);
  radiance.a = alpha;
}

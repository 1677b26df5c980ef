// Twin of core/kinds/kernel_pyramid/shading.py `principled_radiance`, of one material.
#include "lib/draw_lib.glsl"
#include "lib/principled_radiance_lib.glsl"

void main()
{
  Surface surface = Surface(look.base.rgb,
                            look.base.a,
                            look.boundary.x,
                            look.boundary.y,
                            look.emission.a,
                            look.boundary.z,
                            look.specular.a,
                            look.specular.rgb,
                            look.coat.a,
                            look.coating.x,
                            look.coating.y,
                            look.coat.rgb,
                            look.emission.rgb);
  radiance.rgb = principled_radiance(atlas,
                                     places,
                                     ggx,
                                     leaning,
                                     albedos,
                                     rises,
                                     surface,
                                     normalize(world_normal),
                                     view_direction(draw.eye, world_position));
  radiance.a = clamp(surface.alpha, 0.0, 1.0);
}

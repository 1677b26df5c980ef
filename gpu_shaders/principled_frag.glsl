// Twin of core/kinds/kernel_pyramid/shading.py `principled_radiance`, of one material.
#include "lib/footprint_lib.glsl"
#include "lib/principled_radiance_lib.glsl"
#include "lib/seen_samples_lib.glsl"
#include "lib/spread_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  vec3 across, up;
  sample_sides(seen.normal, beside.normal, above.normal, look.coating.z, across, up);
  float spread = pixel_spread(across, up);
  Surface surface = Surface(look.base.rgb,
                            look.base.a,
                            widened_roughness(look.boundary.x, spread),
                            look.boundary.y,
                            look.emission.a,
                            look.boundary.z,
                            look.specular.a,
                            look.specular.rgb,
                            look.coat.a,
                            widened_roughness(look.coating.x, spread),
                            look.coating.y,
                            look.coat.rgb,
                            look.sheen.a,
                            look.boundary.w,
                            look.sheen.rgb,
                            look.emission.rgb);
  radiance.rgb = principled_radiance(atlas,
                                     lookups,
                                     ggx,
                                     leaning,
                                     albedos,
                                     rises,
                                     sheens,
                                     surface,
                                     seen.normal,
                                     seen.normal,
                                     seen.mirror_normal,
                                     seen.mirror_normal,
                                     seen.view_dir);
  radiance.a = clamp(surface.alpha, 0.0, 1.0);
}

// Twin of rsibr_addon/core/kinds/kernel_pyramid/shading.py. Layer 0 of a family's texture (see
// device/kinds/kernel_pyramid.py) holds the tilts of its lobes, then come for each kernel a layer of each
// function, with the weights of these lobes.
#include "lib/directions_lib.glsl"
#include "lib/lobe_axes_lib.glsl"
#include "lib/oren_nayar_lib.glsl"
#include "lib/principled_lib.glsl"
#include "lib/pyramid_lib.glsl"

const int GGX_LOBES = 4;
const int LEANING_LOBES = 2;

// The sum of a family's lobes, GGX_LOBES at most, whose functions are the first of the powers.
vec3 lobes_radiance(sampler2D atlas,
                    sampler2D places,
                    sampler2DArray family,
                    int lobes,
                    int functions,
                    float alpha,
                    float mu,
                    Powers coefficients,
                    vec3 normal,
                    vec3 mirror_dir)
{
  vec2 place = family_place(family, alpha, mu);
  vec4 tilts = textureLod(family, vec3(place, 0.0), 0.0);
  vec2 uv[GGX_LOBES];
  for (int lobe = 0; lobe < lobes; lobe++) {
    uv[lobe] = octahedral_uv(lobe_axis(normal, mirror_dir, vec2(tilts[lobe], 0.0)));
  }
  vec3 radiance = vec3(0.0);
  int kernels = kernel_count(places);
  for (int kernel = 0; kernel < kernels; kernel++) {
    float layer = float(1 + kernel * functions);
    mat4x3 weights = outerProduct(coefficients.zeroth, textureLod(family, vec3(place, layer), 0.0));
    for (int power = 1; power < functions; power++) {
      weights += outerProduct(coefficients.rising[power - 1],
                              textureLod(family, vec3(place, layer + float(power)), 0.0));
    }
    // Broad lobes have no sharp kernels: what has no weight is not looked up
    if (weights != mat4x3(0.0)) {
      for (int lobe = 0; lobe < lobes; lobe++) {
        radiance += weights[lobe] * pyramid_radiance(atlas, places, kernel, uv[lobe]);
      }
    }
  }
  return radiance;
}

// GGX; 0 where signed lobes sum to less.
vec3 ggx_radiance(sampler2D atlas,
                     sampler2D places,
                     sampler2DArray ggx,
                     float alpha,
                     float mu,
                     Powers coefficients,
                     vec3 normal,
                     vec3 mirror_dir)
{
  float share = mirror_share(ggx, alpha);
  vec3 radiance = vec3(0.0);
  if (share < 1.0) {
    Powers rough = coloured(vec3(1.0 - share), coefficients);
    radiance = lobes_radiance(atlas, places, ggx, GGX_LOBES, 5, alpha, mu, rough, normal, mirror_dir);
  }
  if (share > 0.0) {
    vec3 factor = coefficients.zeroth + coefficients.rising * powers_of(mu);
    vec2 uv = octahedral_uv(mirror_dir);
    radiance += share * factor * pyramid_radiance(atlas, places, kernel_count(places), uv);
  }
  return max(radiance, 0.0);
}

// Oren and Nayar's reflection of the base colour.
vec3 diffuse_radiance(sampler2D atlas,
                      sampler2D places,
                      sampler2DArray leaning,
                      vec3 base_color,
                      float roughness,
                      float mu,
                      vec3 normal,
                      vec3 mirror_dir)
{
  vec3 color = max(base_color, 0.0);
  vec2 ab = facets(roughness);
  vec2 uv = octahedral_uv(normal);
  int number = kernel_count(places) + 1;
  vec3 white = PI * pyramid_radiance(atlas, places, number, uv);
  vec3 radiance = ab.x * white;
  if (ab.y > 0.0) {
    vec3 lost = LOST_BY_LEANING * white - pyramid_radiance(atlas, places, number + 1, uv);
    Powers white_facets = Powers(vec3(1.0), mat4x3(0.0));
    vec3 leant = lobes_radiance(
        atlas, places, leaning, LEANING_LOBES, 1, 1.0, mu, white_facets, normal, mirror_dir);
    radiance += ab.y * (bounces(color, roughness, mu) * lost + leant);
  }
  return color * max(radiance, 0.0);
}

// Covered by the surface's alpha. The normals are those of `Seen`: for diffuse light, and for the rest.
vec3 principled_radiance(sampler2D atlas,
                         sampler2D places,
                         sampler2DArray ggx,
                         sampler2DArray leaning,
                         sampler2DArray albedos,
                         sampler2D rises,
                         Surface surface,
                         vec3 normal,
                         vec3 mirror_normal,
                         vec3 view_dir)
{
  vec3 mirror_dir = reflect_dir(view_dir, mirror_normal);
  float mu = clamp(dot(mirror_normal, view_dir), 1e-4, 1.0);
  Layers layers = layers_of(surface, mu, albedos, rises);
  vec3 radiance = layers.emission;
  if (layers.diffuse != vec3(0.0)) {
    radiance += layers.diffuse * diffuse_radiance(atlas,
                                                  places,
                                                  leaning,
                                                  surface.base_color,
                                                  surface.diffuse_roughness,
                                                  clamp(dot(normal, view_dir), 1e-4, 1.0),
                                                  normal,
                                                  reflect_dir(view_dir, normal));
  }
  // One loop for both, so that the program has the lobes' code once
  for (int coat = 0; coat < 2; coat++) {
    Powers coefficients = (coat == 1) ? layers.coat : layers.base;
    float roughness = (coat == 1) ? surface.coat_roughness : surface.roughness;
    if (coefficients.zeroth != vec3(0.0) || coefficients.rising != mat4x3(0.0)) {
      radiance += ggx_radiance(
          atlas, places, ggx, roughness * roughness, mu, coefficients, mirror_normal, mirror_dir);
    }
  }
  return radiance;
}

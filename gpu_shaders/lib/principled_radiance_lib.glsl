// Twin of rsibr_addon/core/kinds/kernel_pyramid/shading.py. Layer 0 of a family's texture (see
// device/kinds/kernel_pyramid.py) holds the tilts of its lobes, then come for each kernel a layer of each
// function, with the weights of these lobes.
#include "lib/bumped_diffuse_lib.glsl"
#include "lib/directions_lib.glsl"
#include "lib/lobe_axes_lib.glsl"
#include "lib/oren_nayar_lib.glsl"
#include "lib/principled_lib.glsl"
#include "lib/pyramid_lib.glsl"

const int GGX_LOBES = 4;
const int LEANING_LOBES = 2;

// Rising powers of glass, of an index of 1.5, over the first of them: device/kinds/kernel_pyramid.py `GLASS`.
const vec4 GLASS = vec4(1.0, 22.052702, -36.772641, 24.508813);

// Coefficients of less are not looked up, beside others of the same lobes: roundings of `GLASS`.
const float LEAST_COEFFICIENT = 1e-3;

// Kernels below the first whose lobes of a width have no weight: concentrations end at (16 / alpha)^2, of the
// width's narrower neighbour.
int kernels_of(sampler2D places, float alpha)
{
  float octaves = 8.5 - 2.0 * log2(max(alpha, 1e-4));
  float number = (octaves <= 4.0) ? octaves + 1.0 : 3.0 + 0.5 * octaves;
  return min(int(number) + 1, kernel_count(places));
}

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
  // What is left beside glass, of which the first of the rising functions is made
  vec3 glass = coefficients.rising[0];
  mat4x3 rest = coefficients.rising - outerProduct(glass, GLASS);
  const vec3 LEAST = vec3(LEAST_COEFFICIENT);
  bvec3 counts = bvec3(any(greaterThan(abs(rest[1]), LEAST)),
                       any(greaterThan(abs(rest[2]), LEAST)),
                       any(greaterThan(abs(rest[3]), LEAST)));
  vec3 radiance = vec3(0.0);
  int kernels = kernels_of(places, alpha);
  for (int kernel = 0; kernel < kernels; kernel++) {
    float layer = float(1 + kernel * functions);
    mat4x3 weights = outerProduct(coefficients.zeroth, textureLod(family, vec3(place, layer), 0.0));
    if (functions > 1 && glass != vec3(0.0)) {
      weights += outerProduct(glass, textureLod(family, vec3(place, layer + 1.0), 0.0));
    }
    if (functions > 1 && counts.x) {
      weights += outerProduct(rest[1], textureLod(family, vec3(place, layer + 2.0), 0.0));
    }
    if (functions > 1 && counts.y) {
      weights += outerProduct(rest[2], textureLod(family, vec3(place, layer + 3.0), 0.0));
    }
    if (functions > 1 && counts.z) {
      weights += outerProduct(rest[3], textureLod(family, vec3(place, layer + 4.0), 0.0));
    }
    // Broad lobes have no sharp kernels: what has no weight is not looked up
    if (weights != mat4x3(0.0)) {
      // As pyramid_radiance, with one place for all
      vec4 map = texelFetch(places, ivec2(kernel, 0), 0);
      for (int lobe = 0; lobe < lobes; lobe++) {
        radiance += weights[lobe] * textureLod(atlas, map.xy + uv[lobe] * map.zw, 0.0).rgb;
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
                      vec3 smooth_normal,
                      vec3 mirror_dir)
{
  vec3 color = max(base_color, 0.0);
  vec2 ab = facets(roughness);
  vec4 left = bumped_cosine(normal, smooth_normal);
  vec2 uv = octahedral_uv(left.xyz);
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
  return left.w * color * max(radiance, 0.0);
}

// Covered by the surface's alpha. The normals are those of `Seen`: for diffuse light, the surface's own
// where that is bumped, and for the rest; and that of the coat's own.
vec3 principled_radiance(sampler2D atlas,
                         sampler2D places,
                         sampler2DArray ggx,
                         sampler2DArray leaning,
                         sampler2DArray albedos,
                         sampler2D rises,
                         Surface surface,
                         vec3 normal,
                         vec3 smooth_normal,
                         vec3 mirror_normal,
                         vec3 coat_normal,
                         vec3 view_dir)
{
  float mu = clamp(dot(mirror_normal, view_dir), 1e-4, 1.0);
  float coat_mu = clamp(dot(coat_normal, view_dir), 1e-4, 1.0);
  Layers layers = layers_of(surface, mu, coat_mu, albedos, rises);
  vec3 radiance = layers.emission;
  if (layers.diffuse != vec3(0.0)) {
    radiance += layers.diffuse * diffuse_radiance(atlas,
                                                  places,
                                                  leaning,
                                                  surface.base_color,
                                                  surface.diffuse_roughness,
                                                  clamp(dot(normal, view_dir), 1e-4, 1.0),
                                                  normal,
                                                  smooth_normal,
                                                  reflect_dir(view_dir, normal));
  }
  // One loop for both, so that the program has the lobes' code once
  for (int coat = 0; coat < 2; coat++) {
    // WebGL chooses no structures by ?:
    Powers coefficients = layers.base;
    if (coat == 1) {
      coefficients = layers.coat;
    }
    float roughness = (coat == 1) ? surface.coat_roughness : surface.roughness;
    vec3 layer_normal = (coat == 1) ? coat_normal : mirror_normal;
    float layer_mu = (coat == 1) ? coat_mu : mu;
    if (coefficients.zeroth != vec3(0.0) || coefficients.rising != mat4x3(0.0)) {
      radiance += ggx_radiance(atlas,
                               places,
                               ggx,
                               roughness * roughness,
                               layer_mu,
                               coefficients,
                               layer_normal,
                               reflect_dir(view_dir, layer_normal));
    }
  }
  return radiance;
}

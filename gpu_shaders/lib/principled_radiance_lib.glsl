// Twin of rsibr_addon/core/kinds/kernel_pyramid/shading.py. Layer 0 of a family's texture (see
// device/kinds/kernel_pyramid_texels.py) holds the tilts of its lobes, then come for each kernel a layer of
// each function, with the lobes' weights. A column of `lookups` tells how many kernels a width and the next
// one need, and of each the place of its map (see pyramid_lib.glsl) and its number.
#include "lib/bumped_diffuse_lib.glsl"
#include "lib/directions_lib.glsl"
#include "lib/lobe_axes_lib.glsl"
#include "lib/oren_nayar_lib.glsl"
#include "lib/principled_lib.glsl"
#include "lib/pyramid_lib.glsl"
#include "lib/suns_lib.glsl"

const int FUNCTIONS = 5;
const int LOBES = 4;
const int LEANING_LOBES = 2;

// Coefficients of glass, of an index of 1.5, over the first rising one: `GLASS` of
// device/kinds/kernel_pyramid_texels.py.
const float GLASS_ZEROTH = 0.45133402;
const vec4 GLASS_RISING = vec4(1.0, 22.052702, -36.772641, 24.508813);

// Coefficients of less are not looked up, beside others of the same lobes: roundings of `GLASS`. That of 1 is
// to be so much less than it was.
const float LEAST = 1e-3;

// The sum of a family's lobes, which has one function or all; first: of its columns.
vec3 lobes_radiance(sampler2D atlas,
                    sampler2D lookups,
                    sampler2DArray family,
                    int first,
                    int functions,
                    int lobes,
                    float alpha,
                    float mu,
                    Powers coefficients,
                    vec3 normal,
                    vec3 mirror_dir)
{
  vec2 place = family_place(family, alpha, mu);
  vec4 tilts = textureLod(family, vec3(place, 0.0), 0.0);
  vec3 axes[4];
  tilted_axes(normal, mirror_dir, tilts, axes);
  vec2 uv[4] = vec2[4](
      octahedral_uv(axes[0]), octahedral_uv(axes[1]), octahedral_uv(axes[2]), octahedral_uv(axes[3]));
  // What is left beside glass, of which the first of the rising functions is made
  vec3 glass = coefficients.rising[0];
  vec3 even = coefficients.zeroth - GLASS_ZEROTH * glass;
  mat4x3 rest = coefficients.rising - outerProduct(glass, GLASS_RISING);
  vec3 factors[FUNCTIONS] = vec3[FUNCTIONS](glass, even, rest[1], rest[2], rest[3]);
  // Those that count are neighbours
  int begin = (glass == vec3(0.0)) ? 1 : 0;
  bvec4 counts = bvec4(any(greaterThan(abs(even), LEAST * coefficients.zeroth)),
                       any(greaterThan(abs(rest[1]), vec3(LEAST))),
                       any(greaterThan(abs(rest[2]), vec3(LEAST))),
                       any(greaterThan(abs(rest[3]), vec3(LEAST))));
  int end = counts.w ? 5 : (counts.z ? 4 : (counts.y ? 3 : (counts.x ? 2 : 1)));
  vec3 radiance = vec3(0.0);
  int column = first + family_column(family, place);
  int kernels = int(texelFetch(lookups, ivec2(column, 0), 0).x);
  Suns suns = suns_of(lookups);
  // Loops end with their test: one that begins with it is run once more in vain, where fragments differ
  int kernel = 0;
  do {
    vec4 map = texelFetch(lookups, ivec2(column, 1 + kernel), 0);
    // Of the first function; a family of one has that of 1 alone
    int layer = 1 + int(map.w) * functions - ((functions > 1) ? 0 : 1);
    mat4x3 weights = mat4x3(0.0);
    int number = begin;
    do {
      vec3 texel = vec3(place, float(layer + number));
      weights += outerProduct(factors[number], textureLod(family, texel, 0.0));
    } while (++number < end);
    for (int lobe = 0; lobe < lobes; lobe++) {
      vec3 shown = atlas_radiance(atlas, map.xyz, uv[lobe]);
      if (MAY_HAVE_SUNS && int(map.w) >= suns.resolved) {
        shown = min(shown, suns.ceiling);
      }
      radiance += weights[lobe] * shown;
    }
  } while (++kernel < kernels);
  return radiance;
}

// GGX; 0 where signed lobes sum to less.
vec3 ggx_radiance(sampler2D atlas,
                     sampler2D lookups,
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
    radiance = lobes_radiance(
        atlas, lookups, ggx, 0, FUNCTIONS, LOBES, alpha, mu, rough, normal, mirror_dir);
  }
  Suns suns = suns_of(lookups);
  float of_suns = MAY_HAVE_SUNS ? sun_mirror_share(suns, alpha) : 0.0;
  if (share > 0.0 || of_suns > 0.0) {
    vec3 factor = coefficients.zeroth + coefficients.rising * powers_of(mu);
    vec3 shown = pyramid_radiance(atlas, lookups, MIRROR_MAP, octahedral_uv(mirror_dir));
    vec3 below = MAY_HAVE_SUNS ? min(shown, suns.ceiling) : shown;
    radiance += factor * (share * below + of_suns * (shown - below));
  }
  radiance = max(radiance, 0.0);
  if (MAY_HAVE_SUNS) {
    vec3 view_dir = reflect_dir(mirror_dir, normal);
    radiance += sunlit_gloss(lookups, suns, alpha, mu, coefficients, normal, view_dir);
  }
  return radiance;
}

// Oren and Nayar's reflection of the base colour.
vec3 diffuse_radiance(sampler2D atlas,
                      sampler2D lookups,
                      sampler2DArray leaning,
                      vec3 base_color,
                      float roughness,
                      float mu,
                      vec3 normal,
                      vec3 smooth_normal,
                      vec3 mirror_dir)
{
  vec3 color = max(base_color, 0.0);
  vec2 ab = fujii_coefficients(roughness);
  vec4 left = bumped_cosine(normal, smooth_normal);
  vec2 uv = octahedral_uv(left.xyz);
  vec3 white = PI * pyramid_radiance(atlas, lookups, COSINE_MAP, uv);
  vec3 radiance = ab.x * white;
  if (MAY_HAVE_FACETS && ab.y > 0.0) {
    vec3 lost = LOST_BY_LEANING * white - pyramid_radiance(atlas, lookups, LEANING_MAP, uv);
    Powers white_facets = Powers(vec3(1.0), mat4x3(0.0));
    // The column before that of the maps
    int column = textureSize(lookups, 0).x - 2;
    vec3 leant = lobes_radiance(
        atlas, lookups, leaning, column, 1, LEANING_LOBES, 1.0, mu, white_facets, normal, mirror_dir);
    if (MAY_HAVE_SUNS) {
      leant += sunlit_leaning(lookups, suns_of(lookups), mu, normal, reflect_dir(mirror_dir, normal));
    }
    radiance += ab.y * (bounces(color, roughness, mu) * lost + leant);
  }
  return left.w * color * max(radiance, 0.0);
}

// White sheen.
vec3 sheen_radiance(
    sampler2D atlas, sampler2D lookups, sampler2D sheens, float roughness, float mu, vec3 normal)
{
  vec4 weights = sheen_weights(sheens, roughness, mu);
  vec2 uv = octahedral_uv(normal);
  vec3 radiance = weights.x * pyramid_radiance(atlas, lookups, COSINE_MAP, uv);
  for (int number = 0; number < 3; number++) {
    radiance += weights[1 + number] * pyramid_radiance(atlas, lookups, RING_MAPS + number, uv);
  }
  return radiance;
}

// Covered by the surface's alpha. The normals are those of `Seen`: for diffuse light, the surface's own
// where that is bumped, and for the rest; and that of the coat's own.
vec3 principled_radiance(sampler2D atlas,
                         sampler2D lookups,
                         sampler2DArray ggx,
                         sampler2DArray leaning,
                         sampler2DArray albedos,
                         sampler2D rises,
                         sampler2D sheens,
                         Surface surface,
                         vec3 normal,
                         vec3 smooth_normal,
                         vec3 mirror_normal,
                         vec3 coat_normal,
                         vec3 view_dir)
{
  float mu = clamp(dot(mirror_normal, view_dir), 1e-4, 1.0);
  float coat_mu = clamp(dot(coat_normal, view_dir), 1e-4, 1.0);
  // Fibres stand on base and coat alike
  vec3 sheen_normal = normalize(mix(normal, coat_normal, clamp(surface.coat_weight, 0.0, 1.0)));
  float sheen_mu = clamp(dot(sheen_normal, view_dir), 0.0, 1.0);
  Layers layers = layers_of(surface, mu, coat_mu, sheen_mu, albedos, rises, sheens);
  vec3 radiance = layers.emission;
  if (MAY_HAVE_SHEEN && layers.sheen != vec3(0.0)) {
    radiance += layers.sheen *
                sheen_radiance(atlas, lookups, sheens, surface.sheen_roughness, sheen_mu, sheen_normal);
  }
  if (layers.diffuse != vec3(0.0)) {
    radiance += layers.diffuse * diffuse_radiance(atlas,
                                                  lookups,
                                                  leaning,
                                                  surface.base_color,
                                                  surface.diffuse_roughness,
                                                  clamp(dot(normal, view_dir), 1e-4, 1.0),
                                                  normal,
                                                  smooth_normal,
                                                  reflect_dir(view_dir, normal));
  }
  // One loop for both, so that the program has the lobes' code once
  int coat = 0;
  do {
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
                               lookups,
                               ggx,
                               roughness * roughness,
                               layer_mu,
                               coefficients,
                               layer_normal,
                               reflect_dir(view_dir, layer_normal));
    }
  } while (++coat < (MAY_BE_COATED ? 2 : 1));
  return radiance;
}

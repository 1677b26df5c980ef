// Twin of rsibr_addon/core/brdf/principled.py. The texture `albedos` (see
// device/kinds/kernel_pyramid_texels.py) has a column for each width and a row for each elevation. Layer 0
// holds the directional albedos of GGX times the powers from 2 onwards; layer 1 that of GGX itself, and twice
// its integral over mu.
//
// The texture `sheens` has a column for each roughness from 0 to 1 and a row for each elevation, as `albedos`
// has: the weights of `SheenTable`, which sum to the albedo.
//
// A program for surfaces without sheen, without a coat, or without rough facets below it, may define
// SHEENLESS, UNCOATED or SMOOTH_DIFFUSE: where fragments may differ, drivers compute both ways of a branch.
#include "lib/family_lib.glsl"
#include "lib/fresnel_powers_lib.glsl"

#ifdef SHEENLESS
const bool MAY_HAVE_SHEEN = false;
#else
const bool MAY_HAVE_SHEEN = true;
#endif
#ifdef UNCOATED
const bool MAY_BE_COATED = false;
#else
const bool MAY_BE_COATED = true;
#endif
#ifdef SMOOTH_DIFFUSE
const bool MAY_HAVE_FACETS = false;
#else
const bool MAY_HAVE_FACETS = true;
#endif

// Greatest factor of what a tinted coat leaves.
const float LARGEST = 1e9;

struct Surface {
  vec3 base_color;
  float metallic;
  float roughness;
  float ior;
  float alpha;
  float diffuse_roughness;
  float specular_level;
  vec3 specular_tint;
  float coat_weight;
  float coat_roughness;
  float coat_ior;
  vec3 coat_tint;
  float sheen_weight;
  float sheen_roughness;
  vec3 sheen_tint;
  vec3 emission;
};

struct Layers {
  Powers coat;
  Powers base;
  vec3 diffuse;
  vec3 emission;
  vec3 sheen;
};

// Of GGX of one width towards one view.
struct Albedo {
  float white;
  vec4 rising;
  float mean;
};

// Twin of core/kinds/kernel_pyramid/shading.py `Families`, as are its members.
Albedo ggx_albedo(sampler2DArray albedos, float alpha, float mu)
{
  vec2 place = family_place(albedos, alpha, mu);
  vec4 rising = textureLod(albedos, vec3(place, 0.0), 0.0);
  vec2 white = textureLod(albedos, vec3(place, 1.0), 0.0).rg;
  float share = mirror_share(albedos, alpha);
  return Albedo(mix(white.x, 1.0, share), mix(rising, powers_of(mu), share), mix(white.y, 1.0, share));
}

float dielectric_mean(float index)
{
  return (index - 1.0) / (4.08567 + 1.00071 * index);
}

// A lobe with the light that bounces between its facets [Kulla2017], and its albedo.
Powers bounced(Powers single, vec3 mean, Albedo albedo, out vec3 reflected)
{
  vec3 again = mean * albedo.mean / (1.0 - mean * (1.0 - albedo.mean));
  vec3 gain = 1.0 + again * ((1.0 - albedo.white) / albedo.white);
  reflected = gain * (albedo.white * single.zeroth + single.rising * albedo.rising);
  return coloured(gain, single);
}

// What a layer leaves for those below: as much of every colour.
float left_of(vec3 reflected)
{
  return clamp(1.0 - max(max(reflected.r, reflected.g), reflected.b), 0.0, 1.0);
}

// Twin of core/lobes/rings.py `SheenTable.at`.
vec4 sheen_weights(sampler2D sheens, float roughness, float mu)
{
  float columns = float(textureSize(sheens, 0).x);
  float column = clamp(roughness, 0.0, 1.0) * (columns - 1.0);
  return textureLod(sheens, vec2((column + 0.5) / columns, mu), 0.0);
}

// The factor of white sheen, and what it leaves for what is below.
vec3 sheen_of(Surface surface, float mu, sampler2D sheens, out float below)
{
  if (!MAY_HAVE_SHEEN || surface.sheen_weight <= 0.0) {
    below = 1.0;
    return vec3(0.0);
  }
  vec3 factor = surface.sheen_weight * max(surface.sheen_tint, 0.0);
  float albedo = dot(sheen_weights(sheens, surface.sheen_roughness, mu), vec4(1.0));
  below = left_of(factor * albedo);
  return factor;
}

// The coat, and what it leaves for what is below.
Powers coat_of(Surface surface, float mu, sampler2DArray albedos, sampler2D rises, out vec3 below)
{
  float weight = clamp(surface.coat_weight, 0.0, 1.0);
  if (!MAY_BE_COATED || weight == 0.0) {
    below = vec3(1.0);
    return Powers(vec3(0.0), mat4x3(0.0));
  }
  float index = max(surface.coat_ior, 1.0);
  Albedo albedo = ggx_albedo(albedos, surface.coat_roughness * surface.coat_roughness, mu);
  vec3 reflected;
  Powers coat = bounced(dielectric(rises, index), vec3(dielectric_mean(index)), albedo, reflected);
  // index^2 - 1 first: little is left of it beside 1 at grazing
  float way = index / sqrt((index - 1.0) * (index + 1.0) + mu * mu);
  vec3 through = min(pow(max(surface.coat_tint, 0.0), vec3(way)), LARGEST);
  below = left_of(weight * reflected) * (1.0 - weight + weight * through);
  return coloured(vec3(weight), coat);
}

Powers metal_of(Surface surface, Albedo albedo)
{
  vec3 f0 = clamp(surface.base_color, 0.0, 1.0);
  vec3 edge = edge_of(f0, clamp(surface.specular_tint, 0.0, 1.0));
  vec3 mean = f0 + (1.0 - f0) / 21.0 - edge / 126.0;
  vec3 reflected;
  return bounced(schlick(f0, edge), mean, albedo, reflected);
}

// The boundary over the diffuse base, and its albedo.
Powers plastic_of(Surface surface, Albedo albedo, sampler2D rises, out vec3 reflected)
{
  float index = max(surface.ior, 1.0);
  float level = max(surface.specular_level, 0.0);
  float amplitude = min((index - 1.0) / (index + 1.0) * sqrt(2.0 * level), 0.99);
  float f0 = amplitude * amplitude;
  vec3 tinted = f0 * clamp(surface.specular_tint, 0.0, 1.0);
  Powers boundary = Powers(tinted, outerProduct(1.0 - tinted, rise(rises, amplitude)));
  float mean = dielectric_mean((1.0 + amplitude) / (1.0 - amplitude));
  float risen = clamp((mean - f0) / (1.0 - f0), 0.0, 1.0);
  return bounced(boundary, tinted + (1.0 - tinted) * risen, albedo, reflected);
}

// coat_mu, sheen_mu: the cosines of the view to the coat's and to the sheen's normal.
Layers layers_of(Surface surface,
                 float mu,
                 float coat_mu,
                 float sheen_mu,
                 sampler2DArray albedos,
                 sampler2D rises,
                 sampler2D sheens)
{
  float covered = clamp(surface.alpha, 0.0, 1.0);
  float metallic = clamp(surface.metallic, 0.0, 1.0);
  Albedo albedo = ggx_albedo(albedos, surface.roughness * surface.roughness, mu);
  vec3 below, reflected;
  Powers coat = coat_of(surface, coat_mu, albedos, rises, below);
  float left;
  vec3 sheen = covered * sheen_of(surface, sheen_mu, sheens, left);
  covered *= left;
  below *= covered;
  Powers plastic = coloured((1.0 - metallic) * below, plastic_of(surface, albedo, rises, reflected));
  Powers metal = coloured(metallic * below, metal_of(surface, albedo));
  return Layers(coloured(vec3(covered), coat),
                Powers(metal.zeroth + plastic.zeroth, metal.rising + plastic.rising),
                below * ((1.0 - metallic) * left_of(reflected)),
                below * surface.emission,
                sheen);
}

// Twin of the blending in rsibr_addon/core/kinds/radiance_views/shading.py: [Cabral1999] sections 3 and 4.
// Layer 2 i of the views' texture array is the diffuse map of view i, layer 2 i + 1 its glossy map.
// Row 0 of the albedo texture is of the diffuse part, row 1 of the glossy part.
#include "lib/reflection_warp_lib.glsl"

#define WARPING_SINGLE 0
#define WARPING_SPLIT 1
#define WARPING_ALBEDO 2

// The divisor of radiance where a source saw it, and its factor where it is shown.
vec3 albedo_at(sampler2D albedo, int warping, int warp, float cosine)
{
  if (warping != WARPING_ALBEDO) {
    return vec3(1.0);
  }
  return textureLod(albedo, vec2(cosine, (warp == WARP_NORMAL) ? 0.25 : 0.75), 0.0).rgb;
}

// Place of a surface point in a source: u, v, the cosine at which the source saw it, and trust.
vec4 seen_by(int fading, int warp, vec3 normal, vec3 view_dir, vec3 source_dir)
{
  return vec4(source_uv(warp, normal, view_dir, camera_frame(source_dir)),
              source_cosine(warp, normal, view_dir, source_dir),
              source_trust(fading, warp, normal, view_dir, source_dir));
}

// Radiance of one view that a warp carries.
vec3 source_radiance(sampler2DArray views, int warping, int warp, int view, vec2 uv)
{
  vec3 diffuse = vec3(0.0);
  vec3 glossy = vec3(0.0);
  if (warp == WARP_NORMAL || warping == WARPING_SINGLE) {
    diffuse = textureLod(views, vec3(uv, float(2 * view)), 0.0).rgb;
  }
  if (warp == WARP_MIRROR) {
    glossy = textureLod(views, vec3(uv, float(2 * view + 1)), 0.0).rgb;
  }
  return diffuse + glossy;
}

// Three sources' radiance over albedo, weighted by barycentric weight times confidence. A single
// warp carries nothing by the normal.
vec3 blend_sources(sampler2DArray views,
                   sampler2D albedo,
                   int warping,
                   int warp,
                   ivec3 sources,
                   vec4 seen[3],
                   vec3 weights)
{
  if (warping == WARPING_SINGLE && warp == WARP_NORMAL) {
    return vec3(0.0);
  }
  vec3 shares = weights * vec3(confidence(seen[0].w), confidence(seen[1].w), confidence(seen[2].w));
  shares /= shares.x + shares.y + shares.z;
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < 3; i++) {
    radiance += shares[i] * source_radiance(views, warping, warp, sources[i], seen[i].xy) /
                albedo_at(albedo, warping, warp, seen[i].z);
  }
  return radiance;
}

// The same from a surface point on: each source, seen from a column of source_dirs, is asked where it shows
// the point.
vec3 warp_and_blend(sampler2DArray views,
                    sampler2D albedo,
                    int warping,
                    int fading,
                    int warp,
                    vec3 normal,
                    vec3 view_dir,
                    ivec3 sources,
                    mat3 source_dirs,
                    vec3 weights)
{
  vec4 seen[3] = vec4[3](seen_by(fading, warp, normal, view_dir, source_dirs[0]),
                         seen_by(fading, warp, normal, view_dir, source_dirs[1]),
                         seen_by(fading, warp, normal, view_dir, source_dirs[2]));
  return blend_sources(views, albedo, warping, warp, sources, seen, weights);
}

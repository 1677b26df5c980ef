// Twin of the blending in rsibr_addon/core/shading.py: [Cabral1999] sections 3 and 4.
// Layer 2 i of the views' texture array is the diffuse map of view i, layer 2 i + 1 its glossy map.
#include "lib/reflection_warp_lib.glsl"

// Weights times confidences, to sum 1.
vec3 blend_shares(vec3 weights, vec3 trust)
{
  vec3 product = weights * trust;
  return product / (product.x + product.y + product.z);
}

vec3 diffuse_radiance(sampler2DArray views, int view, vec2 uv)
{
  return textureLod(views, vec3(uv, float(2 * view)), 0.0).rgb;
}

vec3 glossy_radiance(sampler2DArray views, int view, vec2 uv)
{
  return textureLod(views, vec3(uv, float(2 * view + 1)), 0.0).rgb;
}

vec3 combined_radiance(sampler2DArray views, int view, vec2 uv)
{
  return diffuse_radiance(views, view, uv) + glossy_radiance(views, view, uv);
}

// Confidence in each of three sources.
vec3 confidences(int warp, vec3 normal, vec3 view_dir, vec3 source_dirs[3])
{
  return vec3(confidence(warp, normal, view_dir, source_dirs[0]),
              confidence(warp, normal, view_dir, source_dirs[1]),
              confidence(warp, normal, view_dir, source_dirs[2]));
}

// What is to be looked up by the normal: nothing, for a single warp.
vec3 warped_by_normal(sampler2DArray views,
                      bool split,
                      vec3 normal,
                      vec3 view_dir,
                      ivec3 sources,
                      vec3 source_dirs[3],
                      vec3 weights)
{
  if (!split) {
    return vec3(0.0);
  }
  vec3 shares = blend_shares(weights, confidences(WARP_NORMAL, normal, view_dir, source_dirs));
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < 3; i++) {
    vec2 uv = source_uv(WARP_NORMAL, normal, view_dir, camera_frame(source_dirs[i]));
    radiance += shares[i] * diffuse_radiance(views, sources[i], uv);
  }
  return radiance;
}

// What is to be looked up by the mirrored view direction: glossy radiance, or the whole.
vec3 warped_by_mirror(sampler2DArray views,
                      bool split,
                      vec3 normal,
                      vec3 view_dir,
                      ivec3 sources,
                      vec3 source_dirs[3],
                      vec3 weights)
{
  vec3 shares = blend_shares(weights, confidences(WARP_MIRROR, normal, view_dir, source_dirs));
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < 3; i++) {
    vec2 uv = source_uv(WARP_MIRROR, normal, view_dir, camera_frame(source_dirs[i]));
    radiance += shares[i] * (split ? glossy_radiance(views, sources[i], uv) :
                                     combined_radiance(views, sources[i], uv));
  }
  return radiance;
}

// Twin of rsibr_addon/core/geometry/reflection_warp.py: [Cabral1999] sections 3.2 and 3.3.
#include "lib/directions_lib.glsl"
#include "lib/sphere_map_lib.glsl"

#define WARP_NORMAL 0
#define WARP_MIRROR 1

#define FADING_COSINE 0
#define FADING_DISTANCE 1

const float TRUSTED_COSINE = 0.6;
const float TRUSTED_DISTANCE = 1.0;
const float LEAST_CONFIDENCE = 1e-3;

// Where a source map shows the central direction that a surface point has.
vec2 source_uv(int warp, vec3 normal, vec3 view_dir, mat3 source_frame)
{
  if (warp == WARP_NORMAL) {
    return uv_from_normal(normal * source_frame);
  }
  return uv_from_direction(reflect_dir(view_dir, normal) * source_frame);
}

// Cosine between normal and view at that place of the source map.
float source_cosine(int warp, vec3 normal, vec3 view_dir, vec3 source_view_dir)
{
  if (warp == WARP_NORMAL) {
    return dot(normal, source_view_dir);
  }
  return 0.5 * length(reflect_dir(view_dir, normal) + source_view_dir);
}

// Distance from where the source's mirror warp is singular, in radii of the view's map.
float singularity_distance(vec3 normal, vec3 view_dir, vec3 source_view_dir)
{
  vec3 between = view_dir - source_view_dir;
  vec3 apart = normal - between / max(length(between), 1e-6);
  return length(apart - dot(apart, view_dir) * view_dir);
}

// How far a point is from the singularity, over how far makes it trusted in full.
float source_trust(int fading, int warp, vec3 normal, vec3 view_dir, vec3 source_view_dir)
{
  if (fading == FADING_DISTANCE && warp == WARP_MIRROR) {
    return singularity_distance(normal, view_dir, source_view_dir) / TRUSTED_DISTANCE;
  }
  return source_cosine(warp, normal, view_dir, source_view_dir) / TRUSTED_COSINE;
}

float confidence(float trust)
{
  return clamp(trust, LEAST_CONFIDENCE, 1.0);
}

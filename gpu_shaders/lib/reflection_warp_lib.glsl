// Twin of rsibr_addon/core/geometry/reflection_warp.py: [Cabral1999] sections 3.2 and 3.3.
#include "lib/directions_lib.glsl"
#include "lib/sphere_map_lib.glsl"

#define WARP_NORMAL 0
#define WARP_MIRROR 1

const float TRUSTED_COSINE = 0.6;
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

// Fades a source towards its singularity, where the warp leads to the rim of its map.
float confidence(float cosine)
{
  return clamp(cosine / TRUSTED_COSINE, LEAST_CONFIDENCE, 1.0);
}

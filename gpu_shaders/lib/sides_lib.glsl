// Twin of rsibr_addon/core/geometry/sides.py: what an eye sees of a surface, on either side.
#include "lib/directions_lib.glsl"
#include "lib/draw_lib.glsl"
#include "lib/footprint_lib.glsl"

const float LEAST_RISE = 0.01;
const float LEAST_SHARE = 0.9;

struct Seen {
  vec3 view_dir;
  // On the eye's side, for diffuse light
  vec3 normal;
  // For all that depends on the mirror direction
  vec3 mirror_normal;
  bool outside;
};

// The facet's normal lies on the eye's side.
vec3 tilted_normal(vec3 normal, vec3 view_dir, vec3 facet)
{
  float up = dot(view_dir, facet);
  float least = min(LEAST_SHARE * up, LEAST_RISE);
  if (dot(reflect_dir(view_dir, normal), facet) >= least) {
    return normal;
  }
  vec3 along = normal - dot(normal, facet) * facet;
  along /= max(length(along), 1e-9);
  float aside = dot(view_dir, along);
  float mirrored = sqrt(max(aside * aside + up * up - least * least, 0.0));
  vec3 tilted = (aside + mirrored) * along + (up + least) * facet;
  float size = length(tilted);
  return (size > 1e-9) ? tilted / size : facet;
}

// The unit normal of a fragment's facet on the eye's side, from the places of its neighbours.
vec3 facet_normal(vec3 world_position, vec3 view_dir)
{
  vec3 across, up;
  pixel_sides(world_position, 1.0, across, up);
  vec3 facet = cross(across, up);
  float size = length(facet);
  // What shrinks to a point has no facets
  return (size > 0.0) ? faceforward(facet / size, -view_dir, facet) : view_dir;
}

// front: gl_FrontFacing. A model that mirrors turns the winding around; world_normal, of any length, stays
// that of the outside.
Seen seen_surface(vec4 eye, mat4 model, vec3 world_position, vec3 world_normal, bool front)
{
  bool outside = (front == (determinant(mat3(model)) >= 0.0));
  vec3 view_dir = view_direction(eye, world_position);
  vec3 normal = normalize(outside ? world_normal : -world_normal);
  vec3 facet = facet_normal(world_position, view_dir);
  return Seen(view_dir, normal, tilted_normal(normal, view_dir, facet), outside);
}

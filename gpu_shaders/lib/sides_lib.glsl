// Twin of rsibr_addon/core/geometry/sides.py: what an eye sees of a surface, on either side.
#include "lib/directions_lib.glsl"
#include "lib/draw_lib.glsl"
#include "lib/footprint_lib.glsl"

const float LEAST_RISE = 0.01;
const float LEAST_SHARE = 0.9;

struct Seen {
  vec3 position;
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

// The unit normal of a facet on the eye's side; across and up lie in it.
vec3 facet_normal(vec3 across, vec3 up, vec3 view_dir)
{
  vec3 facet = cross(across, up);
  float size = length(facet);
  // What shrinks to a point has no facets
  return (size > 0.0) ? faceforward(facet / size, -view_dir, facet) : view_dir;
}

// front: gl_FrontFacing. A model that mirrors turns the winding around.
bool sees_outside(mat4 model, bool front)
{
  return front == (determinant(mat3(model)) >= 0.0);
}

// world_normal, of any length, is that of the outside; across and up lie in the facet.
Seen seen_point(vec4 eye, vec3 world_position, vec3 world_normal, vec3 across, vec3 up, bool outside)
{
  vec3 view_dir = view_direction(eye, world_position);
  vec3 normal = normalize(outside ? world_normal : -world_normal);
  vec3 facet = facet_normal(across, up, view_dir);
  return Seen(world_position, view_dir, normal, tilted_normal(normal, view_dir, facet), outside);
}

// The same of a fragment, whose neighbours tell its facet.
Seen seen_surface(vec4 eye, mat4 model, vec3 world_position, vec3 world_normal, bool front)
{
  vec3 across, up;
  pixel_sides(world_position, 1.0, across, up);
  return seen_point(eye, world_position, world_normal, across, up, sees_outside(model, front));
}

vec3 mirrored(Seen seen)
{
  return reflect_dir(seen.view_dir, seen.mirror_normal);
}

// Twin of rsibr_addon/core/geometry/directions.py.

const float PI = 3.14159265;

vec3 reflect_dir(vec3 view_dir, vec3 normal)
{
  return 2.0 * dot(normal, view_dir) * normal - view_dir;
}

// The inverse of reflection; 0 where both directions are opposite, which serves as well.
vec3 mirror_normal(vec3 view_dir, vec3 mirror_dir)
{
  vec3 both = view_dir + mirror_dir;
  return both / max(length(both), 1e-9);
}

// eta: index of refraction behind the surface over that in front of it. Beyond the critical angle, the
// direction along the surface.
vec3 refract_dir(vec3 view_dir, vec3 normal, float eta)
{
  vec3 along = (dot(view_dir, normal) * normal - view_dir) / eta;
  return normalize(along - sqrt(max(1.0 - dot(along, along), 0.0)) * normal);
}

// The normal of a surface that a matrix transforms, of another length: by the matrix of cofactors, the
// inverse's transpose times the determinant, which exists even where a scale is 0.
vec3 transformed_normal(mat3 model, vec3 normal)
{
  mat3 cofactors = mat3(cross(model[1], model[2]), cross(model[2], model[0]), cross(model[0], model[1]));
  return (determinant(model) < 0.0) ? -(cofactors * normal) : cofactors * normal;
}

// Columns are the camera's x (right), y (up) and z (towards the camera) in world coordinates.
mat3 camera_frame(vec3 view_dir)
{
  vec3 x = vec3(-view_dir.y, view_dir.x, 0.0);
  float len = length(x);
  // Straight above and below, where "upright" has no meaning, x is -X.
  x = (len > 1e-7) ? x / len : vec3(-1.0, 0.0, 0.0);
  return mat3(x, cross(view_dir, x), view_dir);
}

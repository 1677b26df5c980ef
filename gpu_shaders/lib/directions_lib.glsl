// Twin of rsibr_addon/core/directions.py.

vec3 reflect_dir(vec3 view_dir, vec3 normal)
{
  return 2.0 * dot(normal, view_dir) * normal - view_dir;
}

// Columns are the camera's x (right), y (up) and z (towards the camera) in world coordinates.
mat3 camera_frame(vec3 view_dir)
{
  vec3 x = vec3(-view_dir.y, view_dir.x, 0.0);
  float len = length(x);
  // Straight above and below, "upright" means nothing: x is -X there.
  x = (len > 1e-7) ? x / len : vec3(-1.0, 0.0, 0.0);
  return mat3(x, cross(view_dir, x), view_dir);
}

// Where the lobes of a surface point lie: twin of core/lobes/fit.py `lobe_axes`; offset is (tilt, turn).
vec3 lobe_axis(vec3 normal, vec3 mirror_dir, vec2 offset)
{
  vec3 up = normal - dot(normal, mirror_dir) * mirror_dir;
  vec3 tangent = offset.x * up + offset.y * cross(normal, mirror_dir);
  float angle = length(tangent);
  // sin(angle) / angle by its series, where the quotient would be 0 / 0
  float slope = (angle > 1e-3) ? sin(angle) / angle : 1.0 - angle * angle / 6.0;
  return cos(angle) * mirror_dir + slope * tangent;
}

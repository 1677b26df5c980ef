// Where the lobes of a surface point lie: twin of core/lobes/fit.py `lobe_axes`.

// offset: (tilt, turn).
vec3 lobe_axis(vec3 normal, vec3 mirror_dir, vec2 offset)
{
  vec3 up = normal - dot(normal, mirror_dir) * mirror_dir;
  vec3 tangent = offset.x * up + offset.y * cross(normal, mirror_dir);
  float angle = length(tangent);
  // sin(angle) / angle by its series, where the quotient would be 0 / 0
  float slope = (angle > 1e-3) ? sin(angle) / angle : 1.0 - angle * angle / 6.0;
  return cos(angle) * mirror_dir + slope * tangent;
}

// Axes in the plane of incidence, as above with a turn of 0. They have one tangent, so that it is found once.
void tilted_axes(vec3 normal, vec3 mirror_dir, vec4 tilts, out vec3 axes[4])
{
  vec3 up = normal - dot(normal, mirror_dir) * mirror_dir;
  float size = length(up);
  vec3 tangent = up / max(size, 1e-9);
  vec4 cosines = cos(size * tilts);
  vec4 sines = sin(size * tilts);
  for (int lobe = 0; lobe < 4; lobe++) {
    axes[lobe] = cosines[lobe] * mirror_dir + sines[lobe] * tangent;
  }
}

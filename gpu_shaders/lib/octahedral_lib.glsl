// Twin of rsibr_addon/core/maps/octahedral.py.

vec2 octahedral_uv(vec3 direction)
{
  vec3 on_octahedron = direction / (abs(direction.x) + abs(direction.y) + abs(direction.z));
  vec2 xy = on_octahedron.xy;
  if (on_octahedron.z < 0.0) {
    // Mirrored about the fold |x| + |y| = 1 of its quadrant
    xy = (1.0 - abs(xy.yx)) * vec2((xy.x < 0.0) ? -1.0 : 1.0, (xy.y < 0.0) ? -1.0 : 1.0);
  }
  return 0.5 * xy + 0.5;
}

// The inverse, of points within the square.
vec3 octahedral_direction(vec2 uv)
{
  vec2 xy = 2.0 * uv - 1.0;
  float z = 1.0 - abs(xy.x) - abs(xy.y);
  if (z < 0.0) {
    xy = (1.0 - abs(xy.yx)) * vec2((xy.x < 0.0) ? -1.0 : 1.0, (xy.y < 0.0) ? -1.0 : 1.0);
  }
  return normalize(vec3(xy, z));
}

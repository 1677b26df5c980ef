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

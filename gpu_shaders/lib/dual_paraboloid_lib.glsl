// Twin of rsibr_addon/core/maps/dual_paraboloid.py, in world coordinates: the front looks along -Y.

// u and v on a sheet, and the sheet's number: 0 front, 1 back. The disk's radius is in half-widths.
vec3 dual_paraboloid_place(vec3 direction, float disk_radius)
{
  vec3 own = vec3(direction.x, direction.z, -direction.y);
  float sheet = (own.z < 0.0) ? 1.0 : 0.0;
  vec3 front = (own.z < 0.0) ? -own : own;
  vec2 xy = vec2(front.x, -front.y) / (1.0 + front.z);
  return vec3(0.5 * disk_radius * xy + 0.5, sheet);
}

// Twin of rsibr_addon/core/geometry/near_room.py.

const float BOX = 1.0;

// Where a map shows what a ray meets; position and middle are relative to where the map was captured. The
// room's kind: 0 for distant surroundings, BOX, or 2 for an ellipsoid.
vec3 near_direction(vec3 position, vec3 direction, float room, vec3 half_size, vec3 middle)
{
  if (room < 0.5) {
    return direction;
  }
  vec3 start = (position - middle) / half_size;
  vec3 ray = direction / half_size;
  float along;
  bool inside;
  if (room == BOX) {
    vec3 size = max(abs(ray), 1e-20);
    vec3 far = (1.0 - start * sign(ray)) / size;
    along = min(far.x, min(far.y, far.z));
    inside = all(lessThan(abs(start), vec3(1.0)));
  }
  else {
    float a = dot(ray, ray);
    float b = dot(start, ray);
    float c = dot(start, start) - 1.0;
    along = (sqrt(max(b * b - a * c, 0.0)) - b) / a;
    inside = c < 0.0;
  }
  return (inside && along > 0.0) ? normalize(position + along * direction) : direction;
}

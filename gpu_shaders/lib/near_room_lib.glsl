// Twin of rsibr_addon/core/geometry/near_room.py.

const float BOX = 1.0;

// The shortest way of a ray, so that one from the point of capture has a direction.
const float LEAST_WAY = 1e-6;

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
  if (room == BOX) {
    vec3 size = max(abs(ray), 1e-20);
    vec3 far = (1.0 - start * sign(ray)) / size;
    along = min(far.x, min(far.y, far.z));
  }
  else {
    float a = dot(ray, ray);
    float b = dot(start, ray);
    float c = dot(start, start) - 1.0;
    along = (sqrt(max(b * b - a * c, 0.0)) - b) / a;
  }
  return normalize(position + max(along, LEAST_WAY) * direction);
}

// How far a place, relative to the middle, is from a room: 0 inside.
float outside_distance(vec3 place, float room, vec3 half_size)
{
  if (room == BOX) {
    return length(max(abs(place) - half_size, 0.0));
  }
  float size = length(place / half_size);
  return length(place) * max(1.0 - 1.0 / max(size, 1e-20), 0.0);
}

// Twin of rsibr_addon/core/maps/cube_map.py.

// u and v on a face, and the face's number: +X -X +Y -Y +Z -Z.
vec3 cube_place(vec3 direction)
{
  vec3 size = abs(direction);
  vec2 st;
  float major;
  float face;
  if (size.x >= size.y && size.x >= size.z) {
    major = direction.x;
    st = vec2((major < 0.0) ? direction.z : -direction.z, -direction.y);
    face = 0.0;
  }
  else if (size.y >= size.z) {
    major = direction.y;
    st = vec2(direction.x, (major < 0.0) ? -direction.z : direction.z);
    face = 2.0;
  }
  else {
    major = direction.z;
    st = vec2((major < 0.0) ? -direction.x : direction.x, -direction.y);
    face = 4.0;
  }
  return vec3(0.5 * st / abs(major) + 0.5, (major < 0.0) ? face + 1.0 : face);
}

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

// Distance between texels around a unit direction, in radians.
float cube_texel_angle(vec3 direction, float size)
{
  vec3 part = abs(direction);
  float major = max(part.x, max(part.y, part.z));
  return 2.0 / size * major * sqrt(major);
}

// Directions of growing s, of growing t and of the face itself, as columns: OpenGL 4.6, table 8.19.
mat3 cube_axes(int face)
{
  float sign = ((face & 1) == 0) ? 1.0 : -1.0;
  if (face < 2) {
    return mat3(0.0, 0.0, -sign, 0.0, -1.0, 0.0, sign, 0.0, 0.0);
  }
  if (face < 4) {
    return mat3(1.0, 0.0, 0.0, 0.0, 0.0, sign, 0.0, sign, 0.0);
  }
  return mat3(sign, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, sign);
}

// The direction that a point of a face shows.
vec3 cube_direction(vec2 uv, int face)
{
  return normalize(cube_axes(face) * vec3(2.0 * uv - 1.0, 1.0));
}

// Column, row and face of a texel that may lie beyond the face's edge: as far down the neighbour as it
// overhangs. Beyond a corner of the cube there is none, and the face is -1.
ivec3 cube_wrap(ivec2 texel, int face, int size)
{
  ivec2 from_centre = 2 * texel + 1 - size;
  ivec2 overhang = max(abs(from_centre) - size, 0);
  if (overhang.x > 0 && overhang.y > 0) {
    return ivec3(0, 0, -1);
  }
  vec3 local = vec3(clamp(from_centre, -size, size), size - overhang.x - overhang.y);
  vec3 place = cube_place(cube_axes(face) * local);
  return ivec3(ivec2(place.xy * float(size)), int(place.z));
}

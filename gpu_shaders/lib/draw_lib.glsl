// The uniform block `draw` of every mesh: model, view, projection, turn, and eye, the
// homogeneous position of the eye in the map set's world: (direction, 0) when orthographic.

vec3 view_direction(vec4 eye, vec3 world_position)
{
  return normalize(eye.xyz - eye.w * world_position);
}

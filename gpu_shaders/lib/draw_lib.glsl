// The uniform block `draw` of every mesh: model, normal_matrix, view, projection, and eye, the
// homogeneous position of the eye in world space: (direction, 0) when orthographic.

vec3 view_direction(vec4 eye, vec3 world_position)
{
  return normalize(eye.xyz - eye.w * world_position);
}

// The uniform block `draw` of every mesh: model, view, projection, turn, and eye, the
// homogeneous position of the eye in the map set's world: (direction, 0) when orthographic; strength, whose x
// the picture is multiplied by when it is brought to the display.

// What a material emits, before that; the least strength is that of device/drawing.py.
vec3 emitted(vec3 emission, vec4 strength)
{
  return emission / max(strength.x, 1e-9);
}

vec3 view_direction(vec4 eye, vec3 world_position)
{
  return normalize(eye.xyz - eye.w * world_position);
}

// From the object to the eye: the view of destination maps.
vec3 object_view_direction(vec4 eye, mat4 model, mat4 turn)
{
  return view_direction(eye, (turn * model[3]).xyz);
}

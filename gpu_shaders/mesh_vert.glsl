// A mesh in world space. The position is transformed in the order of Blender's own draws, so that
// the depths agree to the last bit. What is shaded is turned into the map set's world.

void main()
{
  vec3 world = (draw.model * vec4(position, 1.0)).xyz;
  world_position = (draw.turn * vec4(world, 1.0)).xyz;
  world_normal = (draw.normal_matrix * vec4(normal, 0.0)).xyz;
  gl_Position = draw.projection * (draw.view * vec4(world, 1.0));
}

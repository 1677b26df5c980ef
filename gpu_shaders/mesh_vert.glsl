// A mesh in world space. The position is transformed in the order of Blender's own draws, so that the depths
// agree to the last bit. For shading, position and normal are turned into the map set's world.
#include "lib/directions_lib.glsl"

void main()
{
  vec3 world = (draw.model * vec4(position, 1.0)).xyz;
  world_position = (draw.turn * vec4(world, 1.0)).xyz;
  world_normal = mat3(draw.turn) * transformed_normal(mat3(draw.model), normal);
  gl_Position = draw.projection * (draw.view * vec4(world, 1.0));
}

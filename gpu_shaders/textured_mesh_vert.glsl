// A mesh in world space, as mesh_vert.glsl has it, with what textures need: UV maps, and the normal and
// tangent in the object's space, where normal maps are applied.
#include "lib/directions_lib.glsl"

void main()
{
  vec3 world = (draw.model * vec4(position, 1.0)).xyz;
  world_position = (draw.turn * vec4(world, 1.0)).xyz;
  world_normal = mat3(draw.turn) * transformed_normal(mat3(draw.model), normal);
  object_normal = normal;
  object_tangent = tangent;
  uv_01 = uv_a;
  uv_23 = uv_b;
  gl_Position = draw.projection * (draw.view * vec4(world, 1.0));
}

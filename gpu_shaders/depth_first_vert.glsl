// The depths of a mesh, a little behind those of mesh_vert.glsl, which is a program of its own and may round
// otherwise.

// 8 steps of single precision near 1.
const float BEHIND = 5e-7;

void main()
{
  vec3 world = (draw.model * vec4(position, 1.0)).xyz;
  gl_Position = draw.projection * (draw.view * vec4(world, 1.0));
  gl_Position.z += BEHIND * gl_Position.w;
  world_position = world;
  world_normal = normal;
}

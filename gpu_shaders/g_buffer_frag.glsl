// What lib/seen_samples_lib.glsl needs of a sample.
#include "lib/footprint_lib.glsl"

void main()
{
  vec3 position_across, position_up, normal_across, normal_up;
  pixel_sides(world_position, 1.0, position_across, position_up);
  pixel_sides(world_normal, 1.0, normal_across, normal_up);
  g_buffer_0 = vec4(world_position, float(gl_FrontFacing));
  g_buffer_1 = vec4(world_normal, normal_up.x);
  g_buffer_2 = vec4(position_across, normal_up.y);
  g_buffer_3 = vec4(position_up, normal_up.z);
  g_buffer_4 = vec4(normal_across, 0.0);
}

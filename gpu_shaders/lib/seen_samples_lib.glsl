// What is seen of a mesh at a sample, and at its neighbours, were these on the sample's facet. Shading takes
// differences of these, and not the driver's. So it may also come after the mesh was drawn (DEFERRED), once
// for each sample of a G-buffer.
#include "lib/sides_lib.glsl"

void seen_samples(out Seen here, out Seen beside, out Seen above)
{
#ifdef DEFERRED
  // As g_buffer_frag.glsl writes them
  ivec2 place = ivec2(gl_FragCoord.xy);
  vec4 position = texelFetch(g_buffer_0, place, 0);
  vec4 normal = texelFetch(g_buffer_1, place, 0);
  vec4 position_across = texelFetch(g_buffer_2, place, 0);
  vec4 position_up = texelFetch(g_buffer_3, place, 0);
  vec4 normal_across = texelFetch(g_buffer_4, place, 0);
  vec3 normal_up = vec3(normal.w, position_across.w, position_up.w);
  bool front = position.w > 0.5;
#else
  vec3 position = world_position;
  vec3 normal = world_normal;
  vec3 position_across, position_up, normal_across, normal_up;
  pixel_sides(position, 1.0, position_across, position_up);
  pixel_sides(normal, 1.0, normal_across, normal_up);
  bool front = gl_FrontFacing;
#endif
  bool outside = sees_outside(draw.model, front);
  vec2 to = to_neighbours();
  vec3 across = position_across.xyz;
  vec3 up = position_up.xyz;
  here = seen_point(draw.eye, position.xyz, normal.xyz, across, up, outside);
  beside = seen_point(draw.eye,
                      position.xyz + to.x * across,
                      normal.xyz + to.x * normal_across.xyz,
                      across,
                      up,
                      outside);
  above = seen_point(draw.eye,
                     position.xyz + to.y * up,
                     normal.xyz + to.y * normal_up,
                     across,
                     up,
                     outside);
}

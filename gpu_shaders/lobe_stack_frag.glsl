// Twin of core/kinds/lobe_stack/shading.py `stack_radiance`.
#include "lib/draw_lib.glsl"
#include "lib/lobe_stack_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  vec3 mirror_dir = reflect_dir(view_dir, facing_normal(unit_normal, view_dir));
  vec3 across, up;
  pixel_sides(mirror_dir, stack.antialiased, across, up);
  radiance.rgb = stack_radiance(maps,
                                elevations,
                                int(stack.layout_number),
                                int(stack.lobes),
                                int(stack.taps),
                                int(stack.slices),
                                unit_normal,
                                view_dir,
                                across,
                                up);
  radiance.a = 1.0;
}

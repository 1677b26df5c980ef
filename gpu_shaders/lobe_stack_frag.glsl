// Twin of core/kinds/lobe_stack/shading.py `stack_radiance`.
#include "lib/draw_lib.glsl"
#include "lib/lobe_stack_lib.glsl"

void main()
{
  vec3 unit_normal = normalize(world_normal);
  vec3 view_dir = view_direction(draw.eye, world_position);
  // The region that the pixel reflects, by differences to its neighbours; or its middle alone.
  vec3 mirror_dir = reflect_dir(view_dir, facing_normal(unit_normal, view_dir));
  radiance.rgb = stack_radiance(maps,
                                elevations,
                                int(stack.layout_number),
                                int(stack.lobes),
                                int(stack.taps),
                                int(stack.slices),
                                unit_normal,
                                view_dir,
                                stack.antialiased * dFdx(mirror_dir),
                                stack.antialiased * dFdy(mirror_dir));
  radiance.a = 1.0;
}

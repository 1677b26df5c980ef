// Twin of core/kinds/lobe_stack/shading.py `stack_radiance`.
#include "lib/lobe_stack_lib.glsl"
#include "lib/sides_lib.glsl"

void main()
{
  Seen seen = seen_surface(draw.eye, draw.model, world_position, world_normal, gl_FrontFacing);
  vec3 mirror_dir = reflect_dir(seen.view_dir, seen.mirror_normal);
  vec3 across, up;
  pixel_sides(mirror_dir, stack.antialiased, across, up);
  radiance.rgb = stack_radiance(maps,
                                elevations,
                                int(stack.layout_number),
                                int(stack.lobes),
                                int(stack.taps),
                                int(stack.slices),
                                seen.mirror_normal,
                                seen.view_dir,
                                across,
                                up);
  radiance.a = 1.0;
}

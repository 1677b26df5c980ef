// Twin of core/kinds/lobe_stack/shading.py `stack_radiance`.
#include "lib/lobe_stack_lib.glsl"
#include "lib/seen_samples_lib.glsl"

void main()
{
  Seen seen, beside, above;
  seen_samples(seen, beside, above);
  vec3 mirror_dir = mirrored(seen);
  vec3 across, up;
  sample_sides(mirror_dir, mirrored(beside), mirrored(above), stack.antialiased, across, up);
  radiance.rgb = stack_radiance(maps,
                                elevations,
                                int(stack.layout_number),
                                int(stack.lobes),
                                int(stack.taps),
                                int(stack.slices),
                                LobeSuns(int(stack.suns),
                                         int(stack.kernels),
                                         int(stack.sun_row),
                                         stack.reach,
                                         stack.cone),
                                seen.mirror_normal,
                                seen.view_dir,
                                across,
                                up);
  radiance.a = 1.0;
}

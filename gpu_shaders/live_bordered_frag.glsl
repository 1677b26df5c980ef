// Copies a mip from a strip to the atlas, each face within its neighbours' texels.
#include "lib/live_environment_lib.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int size = first_size >> mip;
  int face = pixel.x / (size + 2);
  vec3 light = bordered_texel(strip, pixel - atlas_corner(first_size, mip, face), face, size);
  texel = vec4(light, 1.0);
}

// Halves a mip of the atlas into a strip.
#include "lib/live_environment_lib.glsl"

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int half_size = first_size >> (mip + 1);
  int face = pixel.x / half_size;
  ivec2 place = ivec2(pixel.x - face * half_size, pixel.y);
#ifdef TENT
  vec3 light = tent_halved(atlas, solid_angles, first_size, mip, face, place);
#else
  vec3 light = box_halved(atlas, first_size, mip, face, place);
#endif
  texel = vec4(light, 1.0);
}

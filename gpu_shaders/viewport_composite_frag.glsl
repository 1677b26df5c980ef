// Brings the previews of one frame to the display, at the depths that they were drawn at. What is
// written here is encoded as sRGB on its way to the window, hence the curve undone.
#include "lib/display_lib.glsl"
#include "lib/transfer_curve_lib.glsl"

// Eight steps of a depth in single precision beside 1: where Blender subdivides on the GPU, vertices
// differ in their last bits from those that it hands out, and depths by up to six.
const float DEPTH_TOLERANCE = 8.0 / 16777216.0;

void main()
{
  if (abs(gl_FragCoord.x - left) < 1.0 || abs(gl_FragCoord.x - right) < 1.0) {
    gl_FragDepth = 0.0;
    colour = vec4(1.0);
    return;
  }
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 seen = texelFetch(previews, pixel, 0);
  if (seen.a == 0.0 || gl_FragCoord.x < left || gl_FragCoord.x > right) {
    discard;
  }
  gl_FragDepth = max(texelFetch(depths, pixel, 0).r - DEPTH_TOLERANCE, 0.0);
  colour = vec4(linear_from_srgb(displayed(display, scale * seen.rgb)), 1.0);
}

// Brings the previews of one frame to the display, at the depths that they were drawn at, where their
// coverage is from `least` to `most`. Colours that are written here are encoded as sRGB on their way to the
// window, hence the curve is undone. Where Blender itself brings radiance to the display, it is written.
#include "lib/display_lib.glsl"
#include "lib/false_colour_lib.glsl"
#include "lib/transfer_curve_lib.glsl"

// Eight steps of a depth in single precision beside 1: where Blender subdivides on the GPU, vertices
// differ in their last bits from those that it hands out, and depths by up to six.
const float DEPTH_TOLERANCE = 8.0 / 16777216.0;

// The scale of differences: its corner beside the line, and its size, in pixels at Blender's own scale;
// numbers are written above it.
const vec2 SCALE_PLACE = vec2(24.0, 24.0);
const vec2 SCALE_SIZE = vec2(192.0, 12.0);

// Radiance is covered by alpha. What Blender shows of nothing has none.
vec3 uncovered(vec4 seen)
{
  return (seen.a > 0.0) ? seen.rgb / seen.a : seen.rgb;
}

void main()
{
  vec2 beside_line = (gl_FragCoord.xy - vec2(max(left, 0.0), 0.0)) / ui_scale;
  vec2 on_scale = (beside_line - SCALE_PLACE) / SCALE_SIZE;
  if (full > 0.0 && on_scale == clamp(on_scale, 0.0, 1.0)) {
    gl_FragDepth = 0.0;
    colour = vec4(linear_from_srgb(heat(on_scale.x)), 1.0);
    return;
  }
  if (abs(gl_FragCoord.x - left) < line || abs(gl_FragCoord.x - right) < line) {
    gl_FragDepth = 0.0;
    colour = vec4(1.0);
    return;
  }
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 seen = texelFetch(previews, pixel, 0);
  bool is_wanted = seen.a > 0.0 && seen.a == clamp(seen.a, least, most);
  if (!is_wanted || gl_FragCoord.x < left || gl_FragCoord.x > right) {
    discard;
  }
  gl_FragDepth = max(texelFetch(depths, pixel, 0).r - DEPTH_TOLERANCE, 0.0);
  vec3 radiance = scale * uncovered(seen);
  if (as_radiance > 0.0) {
    colour = vec4(radiance, seen.a);
    return;
  }
  vec3 shown = displayed(display, radiance);
  if (full > 0.0) {
    vec4 other = texelFetch(others, pixel, 0);
    vec3 apart = abs(displayed(display, others_scale * uncovered(other)) - shown);
    shown = heat(max(apart.r, max(apart.g, apart.b)) / full);
    seen.a = 1.0;
  }
  colour = vec4(linear_from_srgb(shown), seen.a);
}

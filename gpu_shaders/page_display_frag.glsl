// Brings the picture of a web page to its canvas, whose colours are covered by alpha: tasks/export/page.
#include "lib/display_lib.glsl"

void main()
{
  vec4 seen = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  vec3 uncovered = (seen.a > 0.0) ? seen.rgb / seen.a : seen.rgb;
  colour = vec4(displayed(display, scale * uncovered) * seen.a, seen.a);
}

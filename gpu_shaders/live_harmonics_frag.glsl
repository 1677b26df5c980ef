// The nine coefficients, from their rows.
#include "lib/live_environment_lib.glsl"

void main()
{
  texel = vec4(harmonics_of_rows(rows, int(gl_FragCoord.x)), 1.0);
}

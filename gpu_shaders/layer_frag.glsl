// A layer of a picture: radiance times coverage, and coverage. The state of blending says how it is laid over
// what is there, or added to it.

void main()
{
  vec4 seen = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
  colour = vec4(scale * seen.rgb, seen.a);
}

// What is left of what lies behind the objects: a layer holds the shares that are taken of its light, and of
// its coverage. Where nothing lies behind, light that is taken is coverage by black.

void main()
{
  vec4 taken = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
  float mean = (taken.r + taken.g + taken.b) / 3.0;
  colour = (on_nothing > 0.0) ? vec4(0.0, 0.0, 0.0, mean * (1.0 - taken.a)) : 1.0 - taken;
}

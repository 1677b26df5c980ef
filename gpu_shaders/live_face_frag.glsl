// Copies a render to its place in the strip of faces; values that are not radiance become black, or the
// greatest half float.

const float BRIGHTEST = 65504.0;

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(face * textureSize(seen, 0).x, 0);
  vec3 light = texelFetch(seen, pixel, 0).rgb;
  texel = vec4(mix(clamp(light, 0.0, BRIGHTEST), vec3(0.0), isnan(light)), 1.0);
}

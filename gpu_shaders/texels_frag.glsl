// Copies rows of texels to where they belong.

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
  texels = texelFetch(piece, ivec2(texel.x, texel.y + above), 0);
}

// A picture behind all surfaces.

void main()
{
  vec2 place = middle + size * (2.0 * map_uv - 1.0);
  colour = vec4(scale * textureLod(picture, place, 0.0).rgb, 1.0);
}

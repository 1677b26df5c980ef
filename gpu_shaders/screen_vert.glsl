// One triangle that holds the whole target; map_uv runs over [0, 1] within the target.

void main()
{
  map_uv = 0.5 * position + 0.5;
  gl_Position = vec4(position, 0.0, 1.0);
}

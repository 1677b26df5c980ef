// One triangle that holds the whole target, behind all that is drawn there; map_uv runs over [0, 1] within
// the target.

void main()
{
  map_uv = 0.5 * position + 0.5;
  gl_Position = vec4(position, 1.0, 1.0);
}

// The mean of a pixel's samples, which lie side by side.

void main()
{
  ivec2 first = per_axis * ivec2(gl_FragCoord.xy);
  vec4 sum = vec4(0.0);
  for (int row = 0; row < per_axis; row++) {
    for (int column = 0; column < per_axis; column++) {
      sum += texelFetch(samples, first + ivec2(column, row), 0);
    }
  }
  mean = sum / float(per_axis * per_axis);
}

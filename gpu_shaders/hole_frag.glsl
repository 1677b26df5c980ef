// A hole in the picture: it takes all light from what lies behind, and all coverage.

void main()
{
  radiance = vec4(1.0);
}

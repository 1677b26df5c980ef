// A surface that is not a preview but may hide one: it has no coverage.

void main()
{
  radiance = vec4(0.0);
}

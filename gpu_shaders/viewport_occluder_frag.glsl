// A surface that is no preview, but may hide one: covered by nothing.

void main()
{
  radiance = vec4(0.0);
}

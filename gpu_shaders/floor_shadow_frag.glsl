// The irradiance that a mesh takes from the floor, of one lamp.

void main()
{
  radiance = vec4(lamp.irradiance.rgb, 1.0);
}

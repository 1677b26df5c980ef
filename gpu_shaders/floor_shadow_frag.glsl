// The irradiance that a mesh takes from the floor, of one lamp. What is below the floor takes nothing.

void main()
{
  if (world_position.z < 0.0) {
    discard;
  }
  radiance = vec4(lamp.irradiance.rgb, 1.0);
}

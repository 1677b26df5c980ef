// Twin of rsibr_addon/core/antialiased/spread.py: how far a pixel's normals spread.

const float WIDENING = 1.5;

float pixel_spread(vec3 across, vec3 up)
{
  return (dot(across, across) + dot(up, up)) / 24.0;
}

float mean_spread(vec3 mean, float rounding)
{
  float size = max(length(mean), 1e-3);
  return max(1.0 - rounding - size, 0.0) / size;
}

float widened_roughness(float roughness, float spread)
{
  float squared = roughness * roughness;
  return sqrt(sqrt(min(squared * squared + WIDENING * spread, 1.0)));
}

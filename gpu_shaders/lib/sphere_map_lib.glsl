// Twin of rsibr_addon/core/maps/sphere_map.py: [Cabral1999] section 3.3, camera coordinates.

vec3 normal_from_uv(vec2 uv)
{
  vec2 xy = 2.0 * uv - 1.0;
  xy /= max(length(xy), 1.0);
  return vec3(xy, sqrt(max(1.0 - dot(xy, xy), 0.0)));
}

vec2 uv_from_normal(vec3 normal)
{
  vec2 xy = normal.xy;
  float radius = length(xy);
  if (normal.z < 0.0) {
    xy = (radius > 0.0) ? xy / radius : vec2(1.0, 0.0);
  }
  return 0.5 * xy + 0.5;
}

vec3 direction_from_uv(vec2 uv)
{
  vec3 normal = normal_from_uv(uv);
  return vec3(2.0 * normal.z * normal.xy, 2.0 * normal.z * normal.z - 1.0);
}

vec2 uv_from_direction(vec3 direction)
{
  vec3 half_dir = direction + vec3(0.0, 0.0, 1.0);
  float len = length(half_dir);
  // (0, 0, -1) is the whole rim; its rightmost point stands for it.
  return uv_from_normal((len > 1e-6) ? half_dir / len : vec3(1.0, 0.0, 0.0));
}

// Distance between texels in a mirrored sphere's directions, in radians: the same everywhere.
float sphere_map_texel_angle(float size)
{
  return 4.0 / size;
}

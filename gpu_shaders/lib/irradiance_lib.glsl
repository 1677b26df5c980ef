// Twin of rsibr_addon/core/irradiance.py.

// [Ramamoorthi2001] Eq. 12: a quadratic form of the normal for each channel, `irradiance_matrix`.
vec3 irradiance(mat4 red, mat4 green, mat4 blue, vec3 normal)
{
  vec4 n = vec4(normal, 1.0);
  return vec3(dot(n, red * n), dot(n, green * n), dot(n, blue * n));
}

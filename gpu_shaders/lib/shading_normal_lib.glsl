// Twin of rsibr_addon/core/materials/normals.py.

vec3 unit_or(vec3 vector, vec3 other)
{
  float size = dot(vector, vector);
  return (size > 0.0) ? vector * inversesqrt(size) : normalize(other);
}

// The normal that a map's color encodes, in the space of the normal and the tangent.
vec3 mapped_normal(vec3 color, float strength, vec3 normal, vec4 tangent)
{
  vec3 encoded = 2.0 * color - 1.0;
  float upright = mix(1.0, encoded.z, clamp(strength, 0.0, 1.0));
  vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
  vec3 leaning = encoded.x * tangent.xyz + encoded.y * bitangent;
  return unit_or(strength * leaning + upright * normal, normal);
}

// right and above: two steps along the surface, after which it is higher by `rises`.
vec3 bumped_normal(vec3 normal, vec3 right, vec3 above, vec2 rises, float strength)
{
  vec3 across_above = cross(above, normal);
  vec3 across_right = cross(normal, right);
  float area = dot(right, across_above);
  vec3 slope = rises.x * across_above + rises.y * across_right;
  vec3 raised = unit_or(abs(area) * normal - sign(area) * slope, normal);
  float share = max(strength, 0.0);
  return unit_or(share * raised + (1.0 - share) * normal, normal);
}

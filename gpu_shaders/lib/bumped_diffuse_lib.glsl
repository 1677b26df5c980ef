// Twin of rsibr_addon/core/brdf/bumped_diffuse.py.

// The axis of the cosine that is left of Lambert's about a bumped normal, and its share of an even light.
vec4 bumped_cosine(vec3 normal, vec3 smooth_normal)
{
  float fall = 1.0 - clamp(dot(normal, smooth_normal), 0.0, 1.0);
  float chord = sqrt(2.0 * fall);
  vec3 axis = normalize(normal + chord * (0.56 + 0.14 * chord) * smooth_normal);
  return vec4(axis, max(1.0 - 0.87 * fall, 0.3));
}

// Twin of rsibr_addon/core/brdf/fresnel.py.

vec3 fresnel_schlick(float cosine, vec3 f0)
{
  float beside = 1.0 - cosine;
  float beside2 = beside * beside;
  return f0 + (1.0 - f0) * (beside2 * beside2 * beside);
}

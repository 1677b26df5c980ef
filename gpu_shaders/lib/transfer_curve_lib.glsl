// Twin of rsibr_addon/core/light/transfer_curve.py.

vec3 linear_from_srgb(vec3 encoded)
{
  vec3 power = pow((encoded + 0.055) / 1.055, vec3(2.4));
  return mix(power, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

// Twin of rsibr_addon/core/pictures/false_colour.py.

vec3 heat(float number)
{
  return clamp(3.0 * number - vec3(0.0, 1.0, 2.0), 0.0, 1.0);
}

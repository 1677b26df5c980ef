// Twin of rsibr_addon/core/antialiased/footprint.py: what a pixel reflects, of [Miller1984] section 8.

// Corners counterclockwise from the left one at the bottom; across and up are the pixel's whole sides.
void parallelogram(vec3 middle, vec3 across, vec3 up, out vec3 corners[4])
{
  vec3 lower = middle - 0.5 * up;
  vec3 upper = middle + 0.5 * up;
  corners = vec3[4](
      lower - 0.5 * across, lower + 0.5 * across, upper + 0.5 * across, upper - 0.5 * across);
}

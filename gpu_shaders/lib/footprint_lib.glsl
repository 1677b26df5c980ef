// Twin of rsibr_addon/core/antialiased/footprint.py: a pixel's region of directions, [Miller1984] section 8.

// The sides of the region that a pixel reflects, by differences to its neighbours; 0 if antialiased is 0.
void pixel_sides(vec3 direction, float antialiased, out vec3 across, out vec3 up)
{
  across = antialiased * dFdx(direction);
  up = antialiased * dFdy(direction);
}

// The same of a place on a texture.
void pixel_sides(vec2 place, out vec2 across, out vec2 up)
{
  across = dFdx(place);
  up = dFdy(place);
}

// Which way the neighbours lie: drivers take differences within blocks of 2 x 2.
vec2 to_neighbours()
{
  return 1.0 - 2.0 * mod(floor(gl_FragCoord.xy), 2.0);
}

// The sides of a sample's region of directions, of those of the sample and its neighbours; 0 if antialiased
// is 0.
void sample_sides(vec3 here, vec3 beside, vec3 above, float antialiased, out vec3 across, out vec3 up)
{
  vec2 to = antialiased * to_neighbours();
  across = to.x * (beside - here);
  up = to.y * (above - here);
}

// Corners counterclockwise from the left one at the bottom; across and up are the pixel's whole sides.
void parallelogram(vec3 middle, vec3 across, vec3 up, out vec3 corners[4])
{
  vec3 lower = middle - 0.5 * up;
  vec3 upper = middle + 0.5 * up;
  corners = vec3[4](
      lower - 0.5 * across, lower + 0.5 * across, upper + 0.5 * across, upper - 0.5 * across);
}

// Sides of a footprint, taken as a parallelogram.
void footprint_sides(vec3 corners[4], out vec3 across, out vec3 up)
{
  across = 0.5 * (corners[1] - corners[0] + corners[2] - corners[3]);
  up = 0.5 * (corners[3] - corners[0] + corners[2] - corners[1]);
}

// From here on, twin of rsibr_addon/core/antialiased/sampling.py.

// Lookups of a pixel along its sides: a texel apart, as far as `most` allows.
ivec2 sample_counts(vec3 across, vec3 up, float texel_angle, int most)
{
  vec2 sides = vec2(length(across), length(up));
  return ivec2(clamp(ceil(sides / texel_angle), 1.0, float(most)));
}

ivec2 sample_counts(vec3 across, vec3 up, float texel_angle)
{
  return sample_counts(across, up, texel_angle, 4);
}

// The direction of one of these lookups; number runs over the product of the counts.
vec3 sample_direction(vec3 middle, vec3 across, vec3 up, ivec2 counts, int number)
{
  ivec2 cell = ivec2(number % counts.x, number / counts.x);
  vec2 place = (vec2(cell) + 0.5) / vec2(counts) - 0.5;
  return normalize(middle + place.x * across + place.y * up);
}

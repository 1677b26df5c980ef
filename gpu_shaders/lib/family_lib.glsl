// Twin of rsibr_addon/core/lobes/family.py. A texture of a family (see device/kinds/kernel_pyramid_texels.py)
// has a column for each width, six an octave up to 1, and a row for each elevation, in the middles of equal
// steps of mu. So hardware interpolates in log alpha and in mu, with one place for all layers: weights
// rounded to 8 bits are another roughness, by .02 %, and another mu, by 1e-4, not other lobes.

const float WIDTHS_AN_OCTAVE = 6.0;

vec2 family_place(sampler2DArray family, float alpha, float mu)
{
  float widths = float(textureSize(family, 0).x);
  float column = widths - 1.0 + WIDTHS_AN_OCTAVE * log2(max(alpha, 1e-9));
  return vec2((column + 0.5) / widths, mu);
}

// The column at such a place, or the one before.
int family_column(sampler2DArray family, vec2 place)
{
  int widths = textureSize(family, 0).x;
  return clamp(int(floor(place.x * float(widths) - 0.5)), 0, widths - 1);
}

// Share of a mirror in a lobe narrower than the first: the rest is that one's.
float mirror_share(sampler2DArray family, float alpha)
{
  float octaves = float(textureSize(family, 0).x - 1) / WIDTHS_AN_OCTAVE;
  return clamp(1.0 - alpha * exp2(octaves), 0.0, 1.0);
}

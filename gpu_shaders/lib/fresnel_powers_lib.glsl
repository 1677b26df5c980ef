// Twin of rsibr_addon/core/brdf/fresnel_powers.py.

// Coefficients of (1 - cos)^0, and of (1 - cos) to 2, 5, 6 and 7.
struct Powers {
  vec3 zeroth;
  mat4x3 rising;
};

// The powers themselves, from 2 onwards.
vec4 powers_of(float cosine)
{
  float beside = 1.0 - cosine;
  float squared = beside * beside;
  float fifth = squared * squared * beside;
  return vec4(squared, fifth, fifth * beside, fifth * squared);
}

Powers schlick(vec3 f0, vec3 edge)
{
  return Powers(f0, mat4x3(vec3(0.0), 1.0 - f0, -edge, edge));
}

// The tint of a metal's edge: [Kutz2021].
vec3 edge_of(vec3 f0, vec3 tint)
{
  const float SINE = 6.0 / 7.0;
  const float FIFTH = SINE * SINE * SINE * SINE * SINE;
  return (f0 + (1.0 - f0) * FIFTH) * (1.0 - tint) * (7.0 / (FIFTH * SINE));
}

// From the texture of `rise_table`, without its constants, which are 0.
vec4 rise(sampler2D rises, float amplitude)
{
  float count = float(textureSize(rises, 0).x);
  return textureLod(rises, vec2((amplitude * (count - 1.0) + 0.5) / count, 0.5), 0.0);
}

Powers dielectric(sampler2D rises, float index)
{
  float amplitude = (index - 1.0) / (index + 1.0);
  float f0 = amplitude * amplitude;
  return Powers(vec3(f0), outerProduct(vec3(1.0 - f0), rise(rises, amplitude)));
}

// The coefficients, each times a colour.
Powers coloured(vec3 color, Powers powers)
{
  mat4x3 rising = powers.rising;
  return Powers(color * powers.zeroth,
                mat4x3(color * rising[0], color * rising[1], color * rising[2], color * rising[3]));
}

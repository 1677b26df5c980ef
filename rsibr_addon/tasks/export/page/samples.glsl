// What is interpolated over a triangle, at the middle of a sample. Drivers move corners to a grid, of 1/16 to 1/256
// pixel, before they interpolate: a sample has what belongs beside it, which shows where light is sharp.

uniform vec2 samples_in_half;  // Along half of the frame's width and height
in vec4 drawn_clip;

// How far from the sample, in samples, that lies which was interpolated.
vec2 away_from_sample()
{
  return samples_in_half * (drawn_clip.xy / drawn_clip.w + 1.0) - gl_FragCoord.xy;
}

vec3 at_sample(vec3 drawn, vec2 away)
{
  return drawn - away.x * dFdx(drawn) - away.y * dFdy(drawn);
}

vec4 at_sample(vec4 drawn, vec2 away)
{
  return drawn - away.x * dFdx(drawn) - away.y * dFdy(drawn);
}

// The end of a vertex shader, whose own `main` is named `place`: where it placed the corner, for samples.glsl.

out vec4 drawn_clip;

#undef main
void main()
{
  place();
  drawn_clip = gl_Position;
}

// Twin of rsibr_addon/core/kinds/kernel_pyramid/pyramid.py `Pyramid`. The texture `atlas` (see
// device/kinds/kernel_pyramid.py) holds octahedral maps, each within a border of one texel: what continues it
// across its edges. A texel of `places` tells where in the atlas u = v = 0 of a map lies, and how far
// u and v reach from there to 1: the maps of kernels, then what a mirror shows, then both diffuse ones.
#include "lib/octahedral_lib.glsl"

int kernel_count(sampler2D places)
{
  return textureSize(places, 0).x - 3;
}

// A map, at its own u and v.
vec3 pyramid_radiance(sampler2D atlas, sampler2D places, int number, vec2 uv)
{
  vec4 place = texelFetch(places, ivec2(number, 0), 0);
  return textureLod(atlas, place.xy + uv * place.zw, 0.0).rgb;
}

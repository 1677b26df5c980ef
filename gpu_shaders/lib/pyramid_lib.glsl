// Twin of rsibr_addon/core/kinds/kernel_pyramid/pyramid.py `Pyramid`. The texture `atlas` (see
// device/kinds/kernel_pyramid_texels.py) holds octahedral maps, each within a border of one texel: what
// continues it across its edges. Texels of `lookups` tell where in the atlas u = v = 0 of a map lies, and how
// far u reaches from there to 1. The last column has what a mirror shows, both diffuse maps, and the rings;
// the others are those of principled_radiance_lib.glsl.
#include "lib/octahedral_lib.glsl"

const int MIRROR_MAP = 0;
const int COSINE_MAP = 1;
const int LEANING_MAP = 2;
const int RING_MAPS = 3;

// A map at its own u and v, from a texel of `lookups`.
vec3 atlas_radiance(sampler2D atlas, vec3 place, vec2 uv)
{
  vec2 size = vec2(textureSize(atlas, 0));
  return textureLod(atlas, place.xy + uv * place.z * vec2(1.0, size.x / size.y), 0.0).rgb;
}

// One of the maps above.
vec3 pyramid_radiance(sampler2D atlas, sampler2D lookups, int number, vec2 uv)
{
  int last = textureSize(lookups, 0).x - 1;
  return atlas_radiance(atlas, texelFetch(lookups, ivec2(last, number), 0).xyz, uv);
}

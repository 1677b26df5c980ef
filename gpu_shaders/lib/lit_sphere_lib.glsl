// Twin of rsibr_addon/core/geometry/lit_sphere.py `LitSphere.at`.
// The texture (see device/lit_sphere.py) holds the rings, the outermost in row 0, with a column more on
// either side: the one that lies there around the ring.

vec3 lit_sphere_radiance(sampler2D rings, mat3 frame, vec3 normal)
{
  vec3 own = normal * frame;
  vec2 texture_size = vec2(textureSize(rings, 0));
  vec2 size = texture_size - vec2(2.0, 0.0);
  float u = 0.5 - atan(own.y, own.x) / 6.283185307;
  float polar = atan(length(own.xy), own.z);
  float row = max((1.0 - polar / 1.570796327) * size.y - 0.5, 0.0);
  float first = max(floor(row) - 1.0, 0.0);
  // Lagrange's weights of four points, the first at 0
  float p = row - first;
  vec4 weights = vec4(-(p - 1.0) * (p - 2.0) * (p - 3.0) / 6.0,
                      p * (p - 2.0) * (p - 3.0) / 2.0,
                      -p * (p - 1.0) * (p - 3.0) / 2.0,
                      p * (p - 1.0) * (p - 2.0) / 6.0);
  vec3 radiance = vec3(0.0);
  for (int i = 0; i < 4; i++) {
    float ring = first + float(i);
    float around = u;
    if (ring >= size.y) {
      // Beyond the pole, on its far side
      ring = 2.0 * size.y - 1.0 - ring;
      around = fract(u + 0.5);
    }
    vec2 texel = vec2(around * size.x + 1.0, ring + 0.5);
    radiance += weights[i] * textureLod(rings, texel / texture_size, 0.0).rgb;
  }
  return radiance;
}

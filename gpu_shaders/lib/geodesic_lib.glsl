// Twin of rsibr_addon/core/geometry/geodesic.py. The sphere comes as a texture (see
// device/kinds/radiance_views.py): row 0 holds the vertices, row 1 a vector for each of the first level's
// triangles, those of the icosahedron or of any set of views, row 2 + k the triangles of
// subdivision level k as three vertex indices.

vec3 geodesic_vertex(sampler2D sphere, int index)
{
  return texelFetch(sphere, ivec2(index, 0), 0).xyz;
}

vec3 geodesic_centre(sampler2D sphere, int index)
{
  return texelFetch(sphere, ivec2(index, 1), 0).xyz;
}

// Unit vectors to a triangle's corners, as columns.
mat3 geodesic_corners(sampler2D sphere, ivec3 triangle)
{
  return mat3(geodesic_vertex(sphere, triangle.x),
              geodesic_vertex(sphere, triangle.y),
              geodesic_vertex(sphere, triangle.z));
}

ivec3 geodesic_triangle(sampler2D sphere, int level, int index)
{
  return ivec3(texelFetch(sphere, ivec2(index, 2 + level), 0).xyz + 0.5);
}

// Vertex indices of the triangle under a view direction: a descent through the subdivisions.
ivec3 find_triangle(sampler2D sphere, int last_level, vec3 view_dir)
{
  int found = 0;
  float nearest = -2.0;
  // One level alone has as many triangles as the texture has columns
  int count = (last_level > 0) ? 20 : textureSize(sphere, 0).x;
  for (int i = 0; i < count; i++) {
    float cosine = dot(view_dir, geodesic_centre(sphere, i));
    if (cosine > nearest) {
      nearest = cosine;
      found = i;
    }
  }
  for (int level = 1; level <= last_level; level++) {
    ivec3 middle = geodesic_triangle(sphere, level, 4 * found + 3);
    vec3 ab = geodesic_vertex(sphere, middle.x);
    vec3 bc = geodesic_vertex(sphere, middle.y);
    vec3 ca = geodesic_vertex(sphere, middle.z);
    int child = 3;
    if (dot(view_dir, cross(ca, ab)) < 0.0) {
      child = 0;
    }
    else if (dot(view_dir, cross(ab, bc)) < 0.0) {
      child = 1;
    }
    else if (dot(view_dir, cross(bc, ca)) < 0.0) {
      child = 2;
    }
    found = 4 * found + child;
  }
  return geodesic_triangle(sphere, last_level, found);
}

// Signed area of a spherical triangle, [VanOosterom1983].
float spherical_excess(vec3 a, vec3 b, vec3 c)
{
  return 2.0 * atan(dot(a, cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a));
}

// [Cabral1999] section 3.4.
vec3 barycentric_weights(vec3 view_dir, vec3 a, vec3 b, vec3 c)
{
  vec3 areas = vec3(spherical_excess(view_dir, b, c),
                    spherical_excess(view_dir, c, a),
                    spherical_excess(view_dir, a, b));
  areas = max(areas, 0.0);
  float total = areas.x + areas.y + areas.z;
  return (total > 0.0) ? areas / total : vec3(1.0 / 3.0);
}

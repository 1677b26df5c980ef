// Twin of rsibr_addon/core/pictures/display.py.

const float TABLE_SIZE = 96.0;
const float NODES_PER_STOP = 5.0;
const float NODE_OF_ONE = 55.0;
const float KNEE = 7.213475204444817;
const float KNEE_RADIANCE = 0.0013272860490522685;

// In [0, TABLE_SIZE - 1], for each channel.
vec3 node_from_radiance(vec3 radiance)
{
  vec3 exponential = NODE_OF_ONE + NODES_PER_STOP * log2(max(radiance, KNEE_RADIANCE));
  vec3 node = mix(exponential, radiance * (KNEE / KNEE_RADIANCE), lessThan(radiance, vec3(KNEE_RADIANCE)));
  return clamp(node, 0.0, TABLE_SIZE - 1.0);
}

// As sent to the display: interpolated in a tetrahedron of the table's nodes.
vec3 displayed(sampler3D table, vec3 radiance)
{
  vec3 place = node_from_radiance(radiance);
  ivec3 corner = min(ivec3(place), ivec3(TABLE_SIZE) - 2);
  vec3 part = place - vec3(corner);
  // The axes of the largest and of the smallest part: at most one step along each, in that order.
  ivec3 first = (part.r >= part.g && part.r >= part.b) ? ivec3(1, 0, 0) :
                (part.g >= part.b)                     ? ivec3(0, 1, 0) :
                                                         ivec3(0, 0, 1);
  ivec3 last = (part.b <= part.r && part.b <= part.g) ? ivec3(0, 0, 1) :
               (part.g <= part.r)                     ? ivec3(0, 1, 0) :
                                                        ivec3(1, 0, 0);
  float largest = dot(part, vec3(first));
  float smallest = dot(part, vec3(last));
  float middle = part.r + part.g + part.b - largest - smallest;
  return (1.0 - largest) * texelFetch(table, corner, 0).rgb +
         (largest - middle) * texelFetch(table, corner + first, 0).rgb +
         (middle - smallest) * texelFetch(table, corner + 1 - last, 0).rgb +
         smallest * texelFetch(table, corner + 1, 0).rgb;
}

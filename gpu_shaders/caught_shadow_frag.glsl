// The share of its light that a point of a floor loses; the floor lies at z = 0 of its own coordinates, with
// its light above. Shadows fade in the outer quarter of their map. Twin of core/pictures/matte.py,
// `floor_share`.

void main()
{
  vec3 place = (ground.floor_from_world * vec4(world_position, 1.0)).xyz;
  vec2 from_middle = (place.xy - ground.area.xy) / ground.area.z;
  float strength = clamp(4.0 * (1.0 - length(from_middle)), 0.0, 1.0);
  vec3 taken = textureLod(shadow, 0.5 + 0.5 * from_middle, 0.0).rgb;
  vec3 share = clamp(taken / max(ground.irradiance.rgb, vec3(1e-30)), 0.0, 1.0);
  radiance = vec4(strength * share, 0.0);
}

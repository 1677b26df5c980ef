"""One file per map representation, the same four functions in each.

`direction_from_uv`, `uv_from_direction`, `texel_solid_angle` and `wrap`.
"""

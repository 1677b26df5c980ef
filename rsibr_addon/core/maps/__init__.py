"""One file per map representation, the same four functions in each.

`direction_from_uv`, `uv_from_direction`, `texel_solid_angle` and `wrap`. A map of several sheets takes
and gives the number of the sheet with every uv. `representation` has them all by name, all alike.
"""

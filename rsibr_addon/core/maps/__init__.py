"""One file per map representation, the same four functions in each.

`direction_from_uv`, `uv_from_direction`, `texel_solid_angle` and `wrap`. `representation` has them all by
name, all alike. Their parameters and results are those of the methods of the same names of
`representation.Representation`, which tells them once. Here directions are in the map's own axes; solid
angles are those of maps of size x size texels; and a map of one sheet takes and gives no sheet. Docstrings
tell only what differs.
"""

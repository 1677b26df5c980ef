"""The kinds of map sets: what each holds, how it is made, and how it is shaded.

A kind's shading is a function of its maps, `normal`, `view_dir`, a look, `mirror_footprint` and `facet`, and
returns radiance. Normals and view directions are unit vectors in world coordinates, array_like of shape
(..., 3), which are broadcast. `mirror_footprint`, array_like of shape (..., 4, 3), holds the mirrored view
directions at the corners of each point's pixel, over which an antialiased look averages (`core.antialiased`);
it is None for points, which reflect one direction each. `facet`, array_like of shape (..., 3), holds the unit
normals of the facets, and is None for a surface without any. Normals are those of the outside; the inside is
shaded alike (`core.geometry.sides`). Radiance is an ndarray of shape (..., 3), float64. Docstrings of these
functions tell only what differs.
"""

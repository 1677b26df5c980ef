"""Latitude-longitude tables averaged over what a pixel reflects, [Miller1984] section 8.

A footprint is the four unit directions that a pixel's corners reflect, in order around the pixel. Directions
between them are interpolated linearly and normalised, so the footprint's edges are great circles. `recursive`
divides the pixel, `quadrilateral` integrates the table between the edges, `summed_area` takes the smallest
rectangle of the table that holds them, at a constant cost.
"""

"""One map of radiance from photographs at several exposures, which are called a bracket.

`response` finds out how the camera encodes light, `motion` how it was held each time, `merge` puts the
photographs together.
"""

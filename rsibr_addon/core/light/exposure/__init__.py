"""One map of radiance from photographs at several exposures, which are called a bracket.

`response` finds the curve by which the camera encodes light, `motion` finds the camera's movements, and
`merge` merges the photographs.
"""

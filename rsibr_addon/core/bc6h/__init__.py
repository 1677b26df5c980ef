"""BC6H: radiance in 16 bytes for each block of 4x4 texels, as graphics cards decode it.

A block holds the ends of one line through the space of colours, or of two, and for each texel its place
between them. Colours are the bits of half floats taken as whole numbers, in which equal steps are nearly
equal shares of a value. Direct3D 11 and the Khronos Data Format 1.3, section 20, describe it.
"""

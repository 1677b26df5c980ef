"""Complex indices of refraction of metals for red, green and blue."""

from .fresnel import Index

METALS = {
    "aluminium": Index(eta=(1.4257, 0.9358, 0.5778), k=(7.7796, 6.6282, 5.3350)),
    "chromium": Index(eta=(3.6968, 3.0854, 1.8333), k=(4.3059, 4.4617, 4.1329)),
    "copper": Index(eta=(0.0689, 0.9656, 1.2077), k=(3.3168, 2.5983, 2.3600)),
    "gold": Index(eta=(0.0787, 0.3900, 1.5745), k=(3.3978, 2.5277, 1.7722)),
    "nickel": Index(eta=(1.9882, 1.7576, 1.6153), k=(3.7954, 3.2248, 2.5870)),
    "silver": Index(eta=(0.1292, 0.1232, 0.1519), k=(4.0919, 3.3043, 2.3722)),
}
"""Published optical constants n and k, each taken as a spectrum and made a colour.

`rec709_from_spectrum` of the constants from 380 to 780 nm in steps of 1 nm, linear between the tables' own
wavelengths. Reflectances from these stay within 0.05 of the colour of the metal's spectral reflectance, where
that is in the gamut, from normal to grazing incidence; and within [0, 1] where gold's red is not.
"""

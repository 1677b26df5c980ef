"""Complex indices of refraction of metals for red, green and blue."""

from .fresnel import Index

METALS = {
    "aluminium": Index(eta=(1.4253, 0.9357, 0.5779), k=(7.7785, 6.6281, 5.3352)),
    "chromium": Index(eta=(3.6959, 3.0853, 1.8334), k=(4.3057, 4.4617, 4.1329)),
    "copper": Index(eta=(0.0693, 0.9656, 1.2076), k=(3.3165, 2.5983, 2.3601)),
    "gold": Index(eta=(0.0795, 0.3901, 1.5743), k=(3.3971, 2.5277, 1.7723)),
    "nickel": Index(eta=(1.9880, 1.7576, 1.6153), k=(3.7949, 3.2247, 2.5871)),
    "silver": Index(eta=(0.1292, 0.1232, 0.1519), k=(4.0911, 3.3042, 2.3724)),
}
"""Published optical constants n and k, each converted from a spectrum to a colour.

`rec709_from_spectrum` of the constants from 380 to 780 nm in steps of 1 nm, linear between the tables' own
wavelengths. Reflectances from these stay within 0.03 of the colour of the metal's spectral reflectance, where
that is in the gamut, from normal to grazing incidence; where gold's red is outside it, they stay within
[0, 1].
"""

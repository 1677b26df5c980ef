"""Natural light's part of the equations of lobes: kernels are found again, and the norm is that of a sum."""

import numpy as np
from rsibr.rsibr_addon.core.brdf.fresnel import Schlick
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.filtering.zonal import zonal_coefficients
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.natural_light import DEGREE, natural_equations
from rsibr.rsibr_addon.core.lobes.projection import Lookups
from rsibr.rsibr_addon.core.lobes.target import target_slices

BANK = KernelBank((2.0, 16.0))
LOOKUPS = Lookups(np.array([[0.3], [0.9]]), np.ones((2, 1)))


def test_its_share_scales_all() -> None:
    (target,) = target_slices(Ggx(alpha=0.3, fresnel=Schlick(f0=1.0)), [0.7])
    once, twice = (natural_equations(target, BANK, LOOKUPS, share) for share in (1.0, 2.0))
    for one, other in zip(once, twice, strict=True):
        np.testing.assert_allclose(other, 2.0 * one)


def test_products_are_those_of_harmonics() -> None:
    """One kernel about one axis: its power, degree by degree."""
    (target,) = target_slices(Ggx(alpha=0.3, fresnel=Schlick(f0=1.0)), [0.7])
    system, _ = natural_equations(target, BANK, LOOKUPS, 1.0)
    degree = np.arange(1, DEGREE + 1)
    scale = target.power / np.sum(target.albedo**2) / (degree + 1.0)
    for number, kernel in enumerate(BANK.lobes()):
        power = BANK.products(np.zeros(()))[0][number, number]
        expected = np.sum(scale * zonal_coefficients(kernel, DEGREE)[1:] ** 2) / power
        np.testing.assert_allclose(system[number, number], expected)


def test_the_right_side_is_the_quadrature_of_a_smooth_function() -> None:
    """Summed over nodes by the kernels' own harmonics, one after the other."""
    (target,) = target_slices(Ggx(alpha=0.5, fresnel=Schlick(f0=1.0)), [0.6])
    _, right = natural_equations(target, BANK, LOOKUPS, 1.0)
    degree = np.arange(1, DEGREE + 1)
    axis = np.array([np.sin(0.9), 0.0, np.cos(0.9)])
    kernel = BANK.lobes()[1]
    series = zonal_coefficients(kernel, DEGREE)[1:] * target.power / np.sum(target.albedo**2) / (degree + 1.0)
    profile = np.polynomial.legendre.legval(target.light_dir @ axis, np.append(0.0, series))
    unit = 1.0 / np.sqrt(BANK.products(np.zeros(()))[0][1, 1] * target.power)
    expected = unit * (target.weight * profile) @ target.lobe
    np.testing.assert_allclose(right[3], expected, rtol=1e-9)

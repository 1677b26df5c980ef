"""Kernels: closed forms against quadrature, sharpening by squaring, mixtures as zonal lobes."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.filtering.zonal import ZonalLobe, zonal_coefficients
from rsibr.rsibr_addon.core.lobes.bank import BROADEST, SHARPEST, KernelBank, octaves


def sphere(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions and solid angles that integrate polynomials of degree 2 nodes - 1."""
    z, weight = np.polynomial.legendre.leggauss(nodes)
    phi = np.arange(2 * nodes) * np.pi / nodes
    sine = np.sqrt(1.0 - z**2)[:, None]
    x, y = sine * np.cos(phi), sine * np.sin(phi)
    directions = np.stack([x, y, np.broadcast_to(z[:, None], x.shape)], axis=-1).reshape(-1, 3)
    return directions, np.repeat(weight * np.pi / nodes, 2 * nodes)


def kernels_about(bank: KernelBank, angle: float, directions: np.ndarray) -> np.ndarray:
    axis = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return bank.values(0.25 * np.sum((directions - axis) ** 2, axis=-1))


@pytest.mark.parametrize("angle", [-0.4, 0.0, 0.03, 1.2, 3.1])
def test_products_and_their_slopes_are_integrals(angle: float) -> None:
    bank = KernelBank((0.5, 3.0, 40.0, 300.0))
    directions, weight = sphere(150)  # exp(300 cos) has nothing beyond degree 150
    there, here = kernels_about(bank, 0.7 + angle, directions), kernels_about(bank, 0.7, directions)
    products, first, second = bank.products(np.array(angle))
    np.testing.assert_allclose(
        products, np.einsum("n,nk,nl->kl", weight, there, here), rtol=1e-10, atol=1e-12
    )
    step = 1e-4
    before, after = bank.products(np.array(angle - step)), bank.products(np.array(angle + step))
    # Central differences err by step^2 / 6 of derivatives two orders higher: up to kappa of each, here 1e-6
    scale = np.abs(second).max()
    np.testing.assert_allclose(first, (after[0] - before[0]) / (2 * step), atol=2e-6 * scale)
    np.testing.assert_allclose(second, (after[1] - before[1]) / (2 * step), atol=2e-5 * scale)


def test_kernels_integrate_to_one() -> None:
    directions, weight = sphere(100)
    bank = KernelBank((0.5, 7.0, 100.0))
    np.testing.assert_allclose(weight @ kernels_about(bank, 0.3, directions), 1.0, rtol=1e-12)


def test_falls_are_values_over_peaks() -> None:
    bank = KernelBank((0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 64.0))  # doubles with others in between
    distance = np.linspace(0.0, 1.0, 11)
    falls = np.stack([fall.copy() for fall in bank.falls(distance)], axis=-1)
    np.testing.assert_allclose(falls * bank.peaks, bank.values(distance), rtol=1e-12)


def test_a_mixture_filters_as_its_profile_does() -> None:
    bank = octaves(512.0)
    weights = np.array([0.3, -0.2, 0.0, 0.4, 0.1, 0.0, -0.5, 0.2, 0.6, 0.0, 0.1])
    lobe = bank.mixture(weights)
    by_quadrature = zonal_coefficients(ZonalLobe(lobe.profile, lobe.knots), 60)
    np.testing.assert_allclose(zonal_coefficients(lobe, 60), by_quadrature, atol=1e-12)
    assert by_quadrature[0] == pytest.approx(weights.sum(), abs=1e-12)


def test_octaves_double_up_to_what_maps_resolve() -> None:
    bank = octaves(100.0)
    assert bank.concentrations == tuple(BROADEST * 2.0**k for k in range(9))  # 128 is the first above 100
    assert octaves(1e9).concentrations[-1] == SHARPEST
    assert octaves(1e-9).concentrations == (BROADEST,)


@pytest.mark.parametrize("concentrations", [(), (0.0, 1.0), (2.0, 1.0), (1.0, 1.0), (1.0, float("nan"))])
def test_impossible_banks_are_refused(concentrations: tuple[float, ...]) -> None:
    with pytest.raises(RangeError, match="concentrations above 0 in ascending order"):
        KernelBank(concentrations)

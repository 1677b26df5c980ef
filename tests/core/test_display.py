"""Tables of a display's look: nodes and their inverse, and interpolation between them."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.pictures.display import (
    KNEE,
    NODE_OF_ONE,
    NODES_PER_STOP,
    TABLE_SIZE,
    displayed,
    node_from_radiance,
    node_radiance,
    table_radiance,
)


def test_nodes_and_radiance_are_inverse() -> None:
    node = np.linspace(0.0, TABLE_SIZE - 1.0, 10_001)
    np.testing.assert_allclose(node_from_radiance(node_radiance(node)), node, atol=1e-11)
    assert np.all(np.diff(node_radiance(node)) > 0.0)


def test_black_one_and_stops_are_nodes() -> None:
    assert node_radiance(0.0) == 0.0
    assert node_radiance(NODE_OF_ONE) == 1.0
    assert node_radiance(NODE_OF_ONE - 3.0 * NODES_PER_STOP) == 0.125


def test_the_knee_is_smooth() -> None:
    step = 1e-6
    below = node_radiance(KNEE) - node_radiance(KNEE - step)
    above = node_radiance(KNEE + step) - node_radiance(KNEE)
    # One side's slope changes by log(2) / 5 of itself a node.
    assert above == pytest.approx(below, rel=1e-6)


@pytest.mark.parametrize(
    ("radiance", "node"), [(-1.0, 0.0), (1e9, TABLE_SIZE - 1.0), (np.inf, TABLE_SIZE - 1.0)]
)
def test_what_lies_outside_gets_the_nearest_node(radiance: float, node: float) -> None:
    assert node_from_radiance(radiance) == node


def random_radiance() -> np.ndarray:
    """Colours within the table, shape (20000, 3), from its black to its brightest."""
    return node_radiance(np.random.default_rng(1).uniform(0.0, TABLE_SIZE - 1.0, (20_000, 3)))


def test_what_is_linear_in_the_nodes_is_exact() -> None:
    matrix = np.array([[0.5, 0.2, 0.1], [-0.3, 0.8, 0.1], [0.2, 0.2, 0.6]])
    table = node_from_radiance(table_radiance()) @ matrix
    radiance = random_radiance()
    np.testing.assert_allclose(displayed(table, radiance), node_from_radiance(radiance) @ matrix, atol=1e-11)


def test_nodes_give_back_the_table() -> None:
    table = np.random.default_rng(2).random((TABLE_SIZE, TABLE_SIZE, TABLE_SIZE, 3))
    at = np.random.default_rng(3).integers(0, TABLE_SIZE, (3, 5000))
    expected = table[at[2], at[1], at[0]]
    np.testing.assert_allclose(displayed(table, node_radiance(at.T)), expected, atol=1e-11)


def test_greys_are_between_two_greys() -> None:
    table = np.random.default_rng(2).random((TABLE_SIZE, TABLE_SIZE, TABLE_SIZE, 3))
    grey = table[np.arange(TABLE_SIZE), np.arange(TABLE_SIZE), np.arange(TABLE_SIZE)]
    node = np.linspace(0.0, TABLE_SIZE - 1.0, 997)
    expected = np.stack([np.interp(node, np.arange(TABLE_SIZE), channel) for channel in grey.T], axis=-1)
    found = displayed(table, np.repeat(node_radiance(node)[:, None], 3, axis=1))
    np.testing.assert_allclose(found, expected, atol=1e-11)


def test_standard_is_within_a_seventh_of_a_step() -> None:
    def encoded(radiance: np.ndarray) -> np.ndarray:
        clipped = np.clip(radiance, 0.0, 1.0)
        return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1.0 / 2.4) - 0.055)

    radiance = random_radiance()
    # Interpolation errs by 1/8 of the second difference; that of 2^(s / 2.4) with s in steps of 1/5 stop
    # is (log(2) / 12)^2 = 0.0033 of it at most, so 0.11 of 255 steps.
    error = np.abs(displayed(encoded(table_radiance()), radiance) - encoded(radiance))
    assert error.max() < 0.115 / 255.0

"""Errors of pictures against what can be said of them beforehand."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.metrics import relative_rmse, relative_rmse_beyond_noise, unpremultiplied

REFERENCE = np.random.default_rng(5).random((2, 7, 9, 3)) + 0.1
WEIGHT = np.random.default_rng(6).random((2, 7, 9))


def test_known_errors() -> None:
    assert relative_rmse(REFERENCE, REFERENCE, WEIGHT) == 0.0
    # A relative error is the same in every pixel, so no weight and no scale can change it.
    assert relative_rmse(1.25 * REFERENCE, REFERENCE, WEIGHT) == pytest.approx(0.25, rel=1e-12)
    assert relative_rmse(0.0 * REFERENCE, REFERENCE, WEIGHT) == pytest.approx(1.0, rel=1e-12)
    assert relative_rmse([[0.0, 2.0, 0.0]], [[3.0, 0.0, 4.0]], [7.0]) == pytest.approx(np.sqrt(29.0) / 5.0)


def test_what_has_no_weight_does_not_count() -> None:
    weight = WEIGHT.copy()
    weight[:, 3] = 0.0
    ours = REFERENCE.copy()
    ours[:, 3] = 1e6
    assert relative_rmse(ours, REFERENCE, weight) == 0.0


def test_stacked_pictures_pool_their_errors() -> None:
    ours = REFERENCE * np.array([1.1, 0.7])[:, None, None, None]
    power = (WEIGHT[..., None] * REFERENCE**2).sum(axis=(1, 2, 3))
    pooled = np.sqrt((0.1**2 * power[0] + 0.3**2 * power[1]) / power.sum())
    assert relative_rmse(ours, REFERENCE, WEIGHT) == pytest.approx(pooled, rel=1e-12)


def test_a_black_reference_is_refused() -> None:
    with pytest.raises(RangeError, match="black all over"):
        relative_rmse(REFERENCE, 0.0 * REFERENCE, WEIGHT)
    with pytest.raises(RangeError, match="No pixel counts"):
        relative_rmse(REFERENCE, REFERENCE, 0.0 * WEIGHT)


def test_unpremultiplying_undoes_coverage() -> None:
    rgba = np.concatenate([REFERENCE * WEIGHT[..., None], WEIGHT[..., None]], axis=-1)
    np.testing.assert_allclose(unpremultiplied(rgba), REFERENCE, rtol=1e-12)
    assert unpremultiplied(np.zeros((2, 4))).tolist() == [[0.0, 0.0, 0.0]] * 2


def test_noise_of_the_reference_is_no_error() -> None:
    rng = np.random.default_rng(7)
    shape = (400, 400, 3)
    truth, weight = 1.0 + rng.random(shape), rng.random(shape[:-1])
    first, second = (truth + 0.5 * rng.standard_normal(shape) for _ in range(2))
    ours = 1.1 * truth
    # Products of noises average out: 0.5^2 / sqrt(480,000) over the truth's mean square of 2.3.
    assert relative_rmse_beyond_noise(ours, first, second, weight) ** 2 == pytest.approx(0.01, abs=5e-4)
    assert relative_rmse(ours, 0.5 * (first + second), weight) > 0.2
    assert relative_rmse_beyond_noise(truth, truth, truth, weight) == 0.0
    with pytest.raises(RangeError, match="black all over"):
        relative_rmse_beyond_noise(truth, 0.0 * truth, 0.0 * truth, weight)

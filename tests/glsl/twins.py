"""Twins: a function of the shader library and its numpy reference, over the same arguments."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.tests.glsl.evaluation import Samplers, evaluate

COUNT = 100_000
ULP = 2.0**-24
"""Relative rounding error of one operation in single precision."""

AXES = np.concatenate([np.eye(3), -np.eye(3)])


def single(values: np.ndarray) -> np.ndarray:
    """Numbers that single precision holds, so that both twins start from the same."""
    return np.asarray(values, np.float32).astype(np.float64)


def unit_vectors(seed: int, edges: np.ndarray = AXES) -> np.ndarray:
    """Some that matter, and random ones, shape (COUNT, 3)."""
    others = np.random.default_rng(seed).normal(size=(COUNT - len(edges), 3))
    return single(np.concatenate([edges, normalize(others)]))


def disk_points() -> np.ndarray:
    """Points of the map: its corners, centre and rim, and the rim's neighbourhood, among random ones."""
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    rim = 0.5 + 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    near_rim = 0.5 + (rim - 0.5) * (1.0 - 10.0 ** np.linspace(-8.0, -1.0, 200))[:, None]
    edges = np.concatenate([rim, near_rim, [(0.5, 0.5), (0.0, 0.0), (1.0, 1.0), (1.0, 0.5), (0.5, 0.0)]])
    return single(np.concatenate([edges, np.random.default_rng(3).random((COUNT - len(edges), 2))]))


def near_singularity() -> np.ndarray:
    """Directions that leave (0, 0, -1) at many angles; the nearest at 2e-6."""
    away = np.repeat(10.0 ** np.linspace(-5.7, 0.0, 500), 2)
    angle = np.random.default_rng(4).uniform(0.0, 2.0 * np.pi, 1000)
    return normalize(np.stack([away * np.cos(angle), away * np.sin(angle), -np.ones(1000)], axis=-1))


@dataclass(frozen=True)
class Twin:
    """A function of the library: how to call it, what it should say, and how nearly.

    Attributes
    ----------
    library, code : str
        As in `evaluate`.
    arguments : callable
        Makes the arguments, of shape (n, up to 4) each.
    expected : callable
        The arguments to the twin's values, shape (n, channels), or (n, results, channels).
    tolerance : float or callable
        Absolute; a callable gives that of each value from the arguments.
    samplers : callable
        Makes the textures that the code knows by name.
    """

    library: str
    code: str
    arguments: Callable[[], Sequence[np.ndarray]]
    expected: Callable[..., np.ndarray]
    tolerance: float | Callable[..., np.ndarray]
    results: int = 1
    samplers: Callable[[], Samplers] = field(default=dict)


def check(twin: Twin) -> None:
    arguments = twin.arguments()
    assert len(arguments[0]) == COUNT
    found = evaluate(twin.library, twin.code, arguments, twin.results, twin.samplers())
    expected = twin.expected(*arguments).reshape(COUNT, twin.results, -1)
    tolerance = twin.tolerance(*arguments) if callable(twin.tolerance) else twin.tolerance
    error = np.abs(found[..., : expected.shape[-1]] - expected)
    exceeding = ~(error <= np.broadcast_to(tolerance, error.shape))  # also true of NaN
    assert not exceeding.any(), (
        f"{np.count_nonzero(exceeding)} values are off, by up to {error[exceeding].max()}, first for "
        f"{[argument[np.argwhere(exceeding)[0, 0]] for argument in arguments]}"
    )

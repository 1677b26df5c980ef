"""Places of samples within a pixel."""

from collections.abc import Iterator
from itertools import count

STEPS = 0.7548776662466927, 0.5698402909980532
"""1 / p and 1 / p^2 of the plastic number p, p^3 = p + 1."""


def pixel_samples() -> Iterator[tuple[float, float]]:
    """Places in a pixel, evenly spread however many are taken.

    Yields
    ------
    (float, float)
        From the pixel's centre, each in [-0.5, 0.5); the first is the centre.

    Notes
    -----
    The additive recurrence R2 of [Roberts2018], a Kronecker sequence in two dimensions.
    """
    for number in count():
        x, y = ((number * step + 0.5) % 1.0 - 0.5 for step in STEPS)
        yield x, y

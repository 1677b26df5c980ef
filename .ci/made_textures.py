"""Tileable textures of what objects are made of: bricks, rust, paint, leather, leaves."""

import numpy as np
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.geometry.directions import normalize

SIZE = 512
"""Width and height of a texture in texels."""

BRICKS, COURSES, MORTAR = 4, 8, 0.06
"""Bricks in a course, courses, and the mortar's share of a course's height."""


def noise(seed: int, coarse: float, steepness: float = 2.0) -> Array:
    """Fractal noise within 0 and 1, its median .5, shape (SIZE, SIZE).

    Parameters
    ----------
    seed : int
    coarse : float
        Waves across the texture of what is largest in it.
    steepness : float
        Amplitudes fall with this power of the frequency.
    """
    frequency = np.fft.fftfreq(SIZE, 1.0 / SIZE)
    length = np.hypot(frequency[:, None], frequency)
    spectrum = np.fft.fft2(np.random.default_rng(seed).normal(size=(SIZE, SIZE)))
    waves = np.fft.ifft2(spectrum * (coarse**2 + length**2) ** (-0.5 * steepness)).real
    rank = np.empty(SIZE**2)
    rank[np.argsort(waves, axis=None)] = (np.arange(SIZE**2) + 0.5) / SIZE**2
    return rank.reshape(SIZE, SIZE)


def above(values: Array, edge: float, width: float) -> Array:
    """A smooth step from 0 to 1 about `edge`."""
    x = np.clip((values - edge) / width + 0.5, 0.0, 1.0)
    stepped: Array = x * x * (3.0 - 2.0 * x)
    return stepped


def mixed(share: Array, first: tuple[float, ...], second: tuple[float, ...]) -> Array:
    """Colours between two, shape (SIZE, SIZE, 3)."""
    colors: Array = np.asarray(first) + share[..., None] * (np.asarray(second) - np.asarray(first))
    return colors


def normals(height: Array) -> Array:
    """A normal map of a height, both in texels, as 0.5 + 0.5 n: shape (SIZE, SIZE, 3)."""
    along, up = (0.5 * (np.roll(height, -1, axis) - np.roll(height, 1, axis)) for axis in (1, 0))
    return 0.5 + 0.5 * normalize(np.stack([-along, -up, np.ones_like(height)], axis=-1))


def bricks() -> dict[str, Array]:
    """Color, roughness and height in texels of a brick wall."""
    u, v = np.meshgrid(*2 * [(np.arange(SIZE) + 0.5) / SIZE])
    course = np.floor(v * COURSES)
    across, up = BRICKS * u + 0.5 * (course % 2), v * COURSES % 1.0
    edge = np.minimum(2.0 * np.minimum(across % 1.0, 1.0 - across % 1.0), np.minimum(up, 1.0 - up))
    brick = above(edge + 0.03 * (noise(1, 20.0) - 0.5), MORTAR, 0.06)
    tones = np.random.default_rng(2).random((COURSES, BRICKS))
    tone = tones[course.astype(int), np.floor(across).astype(int) % BRICKS]
    grain = noise(3, 30.0, 1.2)
    fired = mixed(tone, (0.38, 0.1, 0.05), (0.55, 0.23, 0.13)) * (0.7 + 0.6 * grain[..., None])
    return {
        "color": np.where(brick[..., None] > 0.5, fired, mixed(grain, (0.35, 0.33, 0.3), (0.5, 0.48, 0.45))),
        "roughness": 0.95 - brick * (0.35 + 0.25 * tone),
        "height": 5.0 * brick + 1.5 * grain,
    }


def rust() -> dict[str, Array]:
    """Color, metallic and roughness of a metal that rusts in patches."""
    patches = above(noise(4, 3.0, 2.4), 0.55, 0.12)
    grain = noise(5, 25.0, 1.4)
    steel = mixed(grain, (0.5, 0.48, 0.45), (0.62, 0.6, 0.58))
    rusty = mixed(grain, (0.12, 0.035, 0.015), (0.42, 0.15, 0.05))
    return {
        "color": steel + patches[..., None] * (rusty - steel),
        "metallic": 1.0 - patches,
        "roughness": 0.28 + 0.1 * grain + 0.5 * patches,
    }


def paint() -> dict[str, Array]:
    """Color of a paint in bands, and where a coat has worn off it."""
    u, v = np.meshgrid(*2 * [(np.arange(SIZE) + 0.5) / SIZE])
    band = above(np.sin(2.0 * np.pi * (3.0 * v + 0.5 * u)), 0.0, 0.1)
    return {
        "color": mixed(band, (0.02, 0.1, 0.35), (0.75, 0.7, 0.6)),
        "coat": above(noise(6, 4.0, 2.2), 0.35, 0.1),
    }


def leather() -> dict[str, Array]:
    """Color and height, from 0 to 1, of leather."""
    rng = np.random.default_rng(7)
    cells = rng.random((700, 2))
    u = np.stack(np.meshgrid(*2 * [(np.arange(SIZE) + 0.5) / SIZE]), axis=-1)
    nearest = np.full((2, SIZE, SIZE), 9.0)
    for cell in cells:
        apart = np.abs(u - cell)
        far = np.hypot(*np.moveaxis(np.minimum(apart, 1.0 - apart), -1, 0))
        nearest = np.sort(np.concatenate([nearest, far[None]]), axis=0)[:2]
    height = above(nearest[1] - nearest[0], 0.008, 0.02)
    tone = 0.5 * noise(8, 3.0) + 0.5 * height
    return {"color": mixed(tone, (0.06, 0.02, 0.01), (0.24, 0.1, 0.05)), "height": height}


def checker(count: int = 8) -> Array:
    """0 and 1 in squares."""
    place = np.arange(SIZE) * count // SIZE
    return (place[:, None] + place) % 2.0


def leaf() -> dict[str, Array]:
    """Color and coverage of a leaf along u, and its height in texels."""
    u, v = np.meshgrid(*2 * [(np.arange(SIZE) + 0.5) / SIZE])
    across = np.abs(v - 0.5)
    half = 0.42 * np.sin(np.pi * np.clip(u, 0.0, 1.0)) ** 0.7 * (1.15 - 0.5 * u)
    teeth = 0.015 * np.abs((24.0 * u) % 1.0 - 0.5)
    ribs = np.minimum(across, 0.35 * np.abs((9.0 * (u - 0.7 * across) + 0.5) % 1.0 - 0.5) / 4.0 + 0.004)
    rib = 1.0 - above(ribs, 0.008, 0.01)
    tone = 0.6 * noise(9, 6.0) + 0.4 * rib
    return {
        "color": mixed(tone, (0.03, 0.12, 0.015), (0.22, 0.4, 0.06)),
        "coverage": above(half + teeth - across, 0.0, 0.01),
        "height": 3.0 * rib + 2.0 * noise(10, 12.0),
    }

"""A scene in closed form, and a camera that photographs it by a curve of its own."""

import numpy as np

RNG = np.random.default_rng(3)
WAVES = RNG.normal(0.0, 0.3, (24, 2))
PHASES = RNG.uniform(0.0, 2.0 * np.pi, (24, 3))
STRENGTHS = RNG.normal(0.0, 1.0, 24)


def scene(points: np.ndarray, contrast: float = 0.35) -> np.ndarray:
    """Radiance at points x + i y [pixels]; lognormal, a few hundred to one; shape (..., 3)."""
    angle = points.real[..., None] * WAVES[:, 0] + points.imag[..., None] * WAVES[:, 1]
    shared = np.cos(angle + PHASES[:, 0]) @ STRENGTHS
    own = np.stack([np.cos(angle[..., :6] + PHASES[:6, i]) @ STRENGTHS[:6] for i in range(3)], axis=-1)
    return np.exp(contrast * (shared[..., None] + 0.5 * own))


def encode(exposure: np.ndarray) -> np.ndarray:
    """A curve unlike sRGB's, with a shoulder, clipped at an exposure of 2, in 8 bits."""
    curve = np.clip(exposure / 2.0, 0.0, 1.0)
    return np.rint(255.0 * (1.3 * curve**0.5 - 0.3 * curve)) / 255.0


def exposure_of(encoded: np.ndarray) -> np.ndarray:
    """The inverse of `encode`, but for rounding: s of 1.3 s - 0.3 s^2 = z."""
    root = (1.3 - np.sqrt(1.3**2 - 1.2 * encoded)) / 0.6
    return 2.0 * root**2


def photograph(points: np.ndarray, time: float, noise: float = 0.0) -> np.ndarray:
    """A photograph whose pixels look at `points`."""
    exposure = scene(points) * time
    return encode(np.maximum(exposure + noise * np.sqrt(exposure) * RNG.standard_normal(exposure.shape), 0.0))

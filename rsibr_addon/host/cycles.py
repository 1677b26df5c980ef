"""Pictures by Cycles, diffuse and glossy radiance apart."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.conventions import Array
from ..core.errors import RangeError
from .denoising import denoise
from .rendering import configure_cycles, render_passes
from .working_space import rec709_from_working

LARGEST_SAMPLES = 1 << 24
LARGEST_SEED = (1 << 31) - 1

WHOLLY = 0.999
"""Coverage above which no sample missed the object."""

ROUNDING = 1e-5
"""Share of a sum of float32 radiance that may be rounding: all of a metal's diffuse part is."""

BYTES_BESIDES = 2e8
"""Bytes of memory that Cycles takes for any render."""

PASSES = ("use_pass_glossy_direct", "use_pass_glossy_color")


@dataclass(frozen=True)
class RenderSettings:
    """Settings of a render.

    Attributes
    ----------
    size : int
        Width and height in pixels.
    samples : int
        Samples a pixel, at least 2: noise is measured as a difference.
    denoise : bool
        Whether Open Image Denoise cleans the two parts.
    seed : int
        Equal seeds give equal pictures, bit by bit.

    Raises
    ------
    RangeError
        A number is out of range.
    """

    size: int
    samples: int
    denoise: bool = False
    seed: int = 0

    def __post_init__(self) -> None:
        if not 4 <= self.size <= 8192:
            raise RangeError(f"A view cannot be {self.size} pixels wide: choose 4 to 8192.")
        if not 2 <= self.samples <= LARGEST_SAMPLES:
            raise RangeError(f"A pixel cannot take {self.samples} samples: choose 2 to {LARGEST_SAMPLES}.")
        if not 0 <= self.seed <= LARGEST_SEED:
            raise RangeError(f"The seed {self.seed} is out of range: choose 0 to {LARGEST_SEED}.")


@dataclass(frozen=True)
class RenderedView:
    """A picture in two parts, which add up to the whole.

    Attributes
    ----------
    diffuse, glossy : ndarray, shape (size, size, 3), float32
        Radiance times coverage: `glossy` is reflected by glossy lobes, `diffuse` is all other
        (Lambert, emission, transmission).
    coverage : ndarray, shape (size, size), float32
        Covered part of each pixel, in [0, 1].
    noise : float
        Relative standard error of the whole radiance before denoising: its root mean square over
        that of the radiance, both in pixels that are wholly covered.
    """

    diffuse: Array
    glossy: Array
    coverage: Array
    noise: float

    @property
    def rgba(self) -> Array:
        """The whole radiance times coverage, and coverage, shape (size, size, 4)."""
        return np.concatenate([self.diffuse + self.glossy, self.coverage[..., None]], axis=-1)


def bytes_needed(texels: int, denoised: bool) -> float:
    """Memory for rendering a view, or a map of the surroundings of a point.

    Returns
    -------
    float
        Bytes, as measured; without `BYTES_BESIDES`, which do not depend on the size.
    """
    return (1500.0 if denoised else 400.0) * texels


def render_view(scene: bpy.types.Scene, settings: RenderSettings) -> RenderedView:
    """Render a scene's convex object in the light of its world.

    Parameters
    ----------
    scene : bpy.types.Scene
        A `temporary_scene` with a camera; its render settings are replaced.
    settings : RenderSettings

    Returns
    -------
    RenderedView
        Row 0 at the bottom; the world itself is not in the picture.

    Raises
    ------
    RenderError

    Notes
    -----
    A convex object reflects light only once, so paths end after that (``max_bounces = 0``; the reflected ray
    that finds the world still counts). Renders are always made on the CPU, so that the same seed
    gives the same bits wherever a capture is resumed.

    The samples are taken in two halves of one sequence: together they are exactly one render of all, and half
    their difference estimates the error. The halves of a low-discrepancy sequence complement each other, so
    this tends to overstate the error: by a quarter for copper in the light of "forest".
    """
    _configure(scene, settings)
    half = settings.samples // 2
    counts = (half, settings.samples - half)
    with _data_kept_between_renders(scene):
        first = _render_subset(scene, 0, counts[0])
        second = _render_subset(scene, counts[0], counts[1])
    inside = np.minimum(first["coverage"], second["coverage"]) > WHOLLY
    noise = _relative_noise(first["whole"][inside], second["whole"][inside], *counts)
    mean = {name: np.average([first[name], second[name]], axis=0, weights=counts) for name in first}
    whole, glossy = mean["whole"], mean["glossy"]
    diffuse = np.where(whole - glossy > ROUNDING * whole, whole - glossy, 0.0)
    if settings.denoise:
        diffuse, glossy = (denoise(part, mean["albedo"], mean["normal"]) for part in (diffuse, glossy))
    return RenderedView(
        rec709_from_working(diffuse).astype(np.float32),
        rec709_from_working(glossy).astype(np.float32),
        mean["coverage"].astype(np.float32),
        noise,
    )


@contextmanager
def _data_kept_between_renders(scene: bpy.types.Scene) -> Iterator[None]:
    """Within, Cycles keeps the scene's data from one render to the next.

    The data must go before the scene does: Blender follows them into the freed scene and crashes.
    """
    scene.render.use_persistent_data = True
    try:
        yield
    finally:
        scene.render.use_persistent_data = False


def _configure(scene: bpy.types.Scene, settings: RenderSettings) -> None:
    configure_cycles(scene, settings.size, settings.size, settings.samples)
    scene.render.film_transparent = True
    scene.cycles.seed = settings.seed
    scene.cycles.use_sample_subset = True
    layer = scene.view_layers[0]
    for name in PASSES:
        setattr(layer, name, True)
    layer.cycles.denoising_store_passes = settings.denoise


def _render_subset(scene: bpy.types.Scene, start: int, count: int) -> dict[str, Array]:
    """A picture of `count` samples from `start` on, with the denoiser's guides where there are any."""
    scene.cycles.sample_offset, scene.cycles.sample_subset_length = start, count
    passes = {name: pixels.astype(np.float64) for name, pixels in render_passes(scene).items()}
    seen: dict[str, Array] = {
        "whole": passes["Combined"][..., :3],
        # Cycles divides light by colour for each pixel, so the product is the light only within one render.
        "glossy": passes["Glossy Direct"] * passes["Glossy Color"],
        "coverage": passes["Combined"][..., 3],
    }
    if "Denoising Albedo" in passes:
        seen |= {"albedo": passes["Denoising Albedo"], "normal": passes["Denoising Normal"]}
    return seen


def _relative_noise(a: Array, b: Array, count_a: int, count_b: int) -> float:
    """Relative noise of the mean of all samples, from the means `a` and `b` of two independent sets.

    var(a - b) = s^2 (1/m + 1/n) and var(mean) = s^2 / (m + n), so the second is m n / (m + n)^2 of
    the first.
    """
    count = count_a + count_b
    variance = count_a * count_b / count**2 * np.sum(np.square(a - b))
    power = np.sum(np.square((count_a * a + count_b * b) / count))
    return float(np.sqrt(variance / power)) if power > 0.0 else 0.0

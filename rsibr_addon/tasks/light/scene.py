"""The light around a point of a scene: [Miller1984] section 5.2."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.environment import usable_radiance
from ...core.light.lamps import LampLight, add_lamps
from ...core.maps import equirect
from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...core.warned import warn
from ...files.memory import check_memory
from ...files.radiance_pictures import check_radiance_target
from ...host.cycles import BYTES_BESIDES, bytes_needed
from ...host.denoising import denoise
from ...host.lamps import lamps_around, measure_lamps
from ...host.surroundings import (
    Sampling,
    Surroundings,
    render_surroundings,
    surroundings_of,
    surroundings_scene,
)
from ...settings.environment import SceneLight
from .scaling import write_scaled

SEEN_WIDTH = 4.0
"""Texels that a lamp must be wide for rays to sample it well: a narrower one is measured."""

PANORAMA_ROWS = 4
"""Rows of pixels for each row of a panorama's texels. Cycles weighs all latitudes within a pixel alike,
however small their circles: beside a pole, light that fills a part of a pixel would count by its height and
not by its area."""

PANORAMA_STEPS = 8
"""A panorama is rendered in so many parts of its samples, so that it can be interrupted."""

OVERLAP = 16
"""Columns that a panorama is continued by on either side while it is denoised."""


def illuminate_from_scene(light: SceneLight, output: Path, force: bool = False) -> Steps[Path]:
    """Render the light around a point of the open file into a latitude-longitude map.

    Between two steps, the open file holds nothing that this adds.

    Raises
    ------
    SceneError
        There is no such scene or object, or nothing around it.
    RangeError
        See `check_memory`.
    RenderError
        Cycles did not deliver.

    Warns
    -----
    RsibrWarning
        The map is black.

    Notes
    -----
    Rays sample lamps that are narrower than `SEEN_WIDTH` badly, and those without size not at all. Cycles
    measures what arrives from them instead; it is added to the texels that hold them.
    """
    check_radiance_target(output, force)
    size = (light.size, light.size // 2)
    check_memory(bytes_needed(size[0] * size[1], light.denoise), str(output), size, BYTES_BESIDES)
    parts = _parts(light)
    total = len(parts) + 1
    yield Progress(0, total, "measuring lamps")
    around = surroundings_of(light.scene, light.subject, light.point, light.frame)
    lamps, names = _small_lamps(around, light.size)
    around = replace(around, unseen=names)
    seen: dict[int | None, dict[str, Array]] = {}
    for done, (face, sampling) in enumerate(parts, start=1):
        yield Progress(done, total, f"rendering part {done} of {len(parts)}")
        with surroundings_scene(around) as scene:
            picture = render_surroundings(scene, around, face, _resolution(light), sampling)
        share = sampling.count / sampling.total
        mean = seen.setdefault(face, {})
        for name, pixels in picture.items():
            texels = pixels if light.faces else _merged_rows(pixels)
            mean[name] = mean.get(name, 0.0) + share * texels.astype(np.float64)
    radiance = add_lamps(_assembled(light, seen), lamps)
    if not np.any(radiance):
        warn(f"No light arrives there, so {output} is black.")
    write_scaled(output, usable_radiance(radiance, output.name), light, force)
    return output


def _resolution(light: SceneLight) -> tuple[int, int]:
    """Width and height of a picture in pixels."""
    half = light.size // 2
    return (half, half) if light.faces else (light.size, half * PANORAMA_ROWS)


def _parts(light: SceneLight) -> list[tuple[int | None, Sampling]]:
    """Pictures that are rendered one by one: which face, and which of its samples."""
    if light.faces:
        whole = Sampling(0, light.samples, light.samples, light.seed, light.denoise)
        return [(face, whole) for face in range(6)]
    samples = -(-light.samples // PANORAMA_ROWS)
    edges = sorted({samples * step // PANORAMA_STEPS for step in range(PANORAMA_STEPS + 1)})
    return [
        (None, Sampling(start, end - start, samples, light.seed, light.denoise))
        for start, end in pairwise(edges)
    ]


def _small_lamps(around: Surroundings, size: int) -> tuple[list[LampLight], frozenset[str]]:
    """Light of the lamps that rays would miss, and the names of those lamps."""
    with surroundings_scene(around) as scene:
        lamps = [
            lamp for lamp in lamps_around(scene, around.point) if lamp.width < SEEN_WIDTH * 2.0 * np.pi / size
        ]
        if not lamps:
            return [], frozenset()
        measured = zip(lamps, measure_lamps(scene, around, lamps), strict=True)
        lights = [LampLight(lamp.directions, irradiance) for lamp, irradiance in measured]
        return lights, frozenset(lamp.name for lamp in lamps)


def _assembled(light: SceneLight, seen: dict[int | None, dict[str, Array]]) -> Array:
    """The map of what was rendered, shape (size / 2, size, 3)."""
    if light.faces:
        cube = np.stack([_radiance(light, seen[face], 0) for face in range(6)])
        made: Array = resample(cube, representation("cube_map"), representation("equirect"), light.size)[0]
        return made
    return _radiance(light, seen[None], OVERLAP)


def _merged_rows(pixels: Array) -> Array:
    """Means over the texels of a panorama that was rendered with more rows."""
    rows, width, channels = pixels.shape
    weight = equirect.texel_solid_angle(1, rows).reshape(-1, PANORAMA_ROWS, 1, 1)
    share = weight / weight.sum(axis=1, keepdims=True)
    return np.sum(share * pixels.reshape(-1, PANORAMA_ROWS, width, channels), axis=1)


def _radiance(light: SceneLight, passes: dict[str, Array], overlap: int) -> Array:
    """A picture's radiance, denoised if the settings say so; `overlap` columns continue it on either side."""
    if not light.denoise:
        return passes["radiance"]
    around = ((0, 0), (overlap, overlap), (0, 0))
    wide = [np.pad(passes[name], around, mode="wrap") for name in ("radiance", "albedo", "normal")]
    clean = denoise(*wide)
    return np.maximum(clean[:, overlap : clean.shape[1] - overlap], 0.0)

"""The materials that come with us, as a library of Blender's assets with pictures of our own shading."""

from pathlib import Path
from typing import Any

import numpy as np

from ..core.brdf.cycles_presets import PRESETS, preset_title
from ..core.brdf.principled import Surface
from ..core.conventions import Array
from ..core.materials.surfaces import surface_at
from ..core.progress import Progress, Steps
from ..files.atomic import check_target, written_aside
from ..host.assets import Asset, write_library
from ..host.display import displayed_colours
from ..host.presets import build_preset
from ..host.principled import principled
from ..host.scenes import temporary_scene
from .reflectance.material_picture import lit_pyramid, principled_sphere

SIZE, SAMPLES = 128, 2
"""Width of the pictures in pixels, and samples along each axis of a pixel."""

MAPS = 1024
"""Width of the sharpest maps in texels, as chrome needs."""


def write_assets(output: Path, force: bool = False) -> Steps[list[str]]:
    """Write the materials that come with us into a file, as assets.

    Parameters
    ----------
    output : Path
        NAME.blend.
    force : bool
        Whether an existing file is replaced.

    Returns
    -------
    list of str
        The materials' names.

    Raises
    ------
    OutputFileError
        The file exists, or cannot be written.
    InputFileError
        Blender's environment is not there.
    """
    check_target(output, force, (".blend",))
    with temporary_scene():
        surfaces = {name: _surface(build_preset(name)) for name in PRESETS}
    pyramid = yield from lit_pyramid(MAPS)
    pictures = {}
    for number, (name, surface) in enumerate(surfaces.items()):
        yield Progress(number, len(PRESETS), f"drawing {name}")
        pictures[name] = principled_sphere(pyramid, surface, SIZE * SAMPLES)
    with temporary_scene() as scene, written_aside(output, force) as aside:
        assets = [
            Asset(build_preset(name), preset_title(name), preset.summary, _displayed(scene, pictures[name]))
            for name, preset in PRESETS.items()
        ]
        write_library(aside, assets)
    return list(map(preset_title, PRESETS))


def _surface(material: Any) -> Surface:
    return surface_at(principled(material), {}, {"": np.zeros((1, 2))})


def _displayed(scene: Any, picture: Array) -> Array:
    """A picture as the display shows it, shape (SIZE, SIZE, 4)."""
    covered = picture[..., 3:]
    shown = np.concatenate([covered * displayed_colours(scene, picture[..., :3]), covered], axis=-1)
    means = shown.reshape(SIZE, SAMPLES, SIZE, SAMPLES, 4).mean(axis=(1, 3))
    means[..., :3] /= np.maximum(means[..., 3:], 1e-6)
    return means

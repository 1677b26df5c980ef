"""A map in another representation: from pictures to pictures."""

import math
from functools import partial
from pathlib import Path

import numpy as np

from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.map_pictures import check_map_target, layout, read_map, write_map
from ...files.memory import check_memory
from ...files.radiance_pictures import describe_radiance
from ...settings.convert import ConvertSettings
from .light_pictures import read_light

BYTES_OF_TEXEL = 80
"""Bytes of memory for each texel of a new map: means over the old texels are summed in double precision."""


def convert(source: Path, settings: ConvertSettings, output: Path, force: bool = False) -> Steps[list[Path]]:
    """Convert a map, and give the files that were written.

    Parameters
    ----------
    source : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone; of maps with a file
        for each sheet NAME.exr for NAME-SHEET.exr.

    Raises
    ------
    InputFileError
        A file is missing or unreadable, its size does not fit the layout, or it holds no finite
        value.
    RangeError
        The values do not fit into Radiance HDR, or the map into this machine's memory; or its
        size does not fit the layout.

    Warns
    -----
    RsibrWarning
        See `core.environment.usable_radiance`.
    """
    before, after = (
        layout(name, **settings.parameters(name)) for name in (settings.source_layout, settings.target_layout)
    )
    check_map_target(output, after, force, before.paths(source))
    sheets, height, width = after.representation.shape(settings.size)
    check_memory(BYTES_OF_TEXEL * sheets * height * width, str(output), (width, height))
    yield Progress(0, 3, f"reading {source.name}")
    image = read_map(source, before, partial(read_light, clamp=settings.clamp))
    yield Progress(1, 3, f"making {output.name}")
    if settings.source_layout == settings.target_layout == "equirect" and image.shape[2] == settings.size:
        made = image
    else:
        made = resample(image, before.representation, after.representation, settings.size, np.float32)
    del image
    yield Progress(2, 3, f"writing {output.name}")
    return write_map(output, after, made, force)


def made_environment(source: Path, layout_name: str, output: Path, force: bool = False) -> Steps[Path]:
    """Convert a map of light to an environment of as many texels; see `convert` for what is raised.

    Parameters
    ----------
    source : Path
        One of the map's files: a picture of radiance.
    layout_name : str
        One of `settings.environment.LAYOUTS`.
    """
    before = layout(layout_name)
    width, height = describe_radiance(source).size
    texels = width * height * len(before.paths(before.whole(source)))
    settings = ConvertSettings(
        source_layout=layout_name, target_layout="equirect", size=2 * math.ceil(math.sqrt(texels / 2.0))
    )
    (made,) = yield from convert(before.whole(source), settings, output, force)
    return made

"""A map in another representation: from pictures to pictures."""

from functools import partial
from pathlib import Path

import numpy as np

from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.map_pictures import check_map_target, layout, read_map, write_map
from ...files.memory import check_memory
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
    check_map_target(output, after, force)
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

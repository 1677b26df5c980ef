"""A map in another representation: from pictures to pictures."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ...core.errors import RangeError
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.map_pictures import Layout, check_map_target, layout, read_map, write_map
from ...files.memory import check_memory
from .light_pictures import read_light

LARGEST = 16384
"""Width of the largest map."""

BYTES_OF_TEXEL = 80
"""Of memory for each texel of a new map: means over the old map's texels are summed in double precision."""


@dataclass(frozen=True)
class ConvertSettings:
    """How a map is laid out, and how it shall be.

    Attributes
    ----------
    source, target : str
        Names of layouts: see `files.map_pictures.layout`.
    size : int
        Width of the new map in texels, or of each of its faces or sheets.
    overscan : float or None
        Of paraboloids, old or new: see `core.maps.dual_paraboloid`; None where there are none, or for 1.
    distance : float or None
        Of the camera from mirror balls: see `core.maps.mirror_ball`; None where there are none, or for
        a camera far away.
    clamp : float or None
        See `core.environment.usable_radiance`.

    Raises
    ------
    RangeError
        A parameter is out of its range, or belongs to neither layout.
    """

    source: str
    target: str
    size: int
    overscan: float | None = None
    distance: float | None = None
    clamp: float | None = None

    def __post_init__(self) -> None:
        for name, owner in PARAMETERS.items():
            if getattr(self, name) is not None and owner not in (self.source, self.target):
                raise RangeError(f"Neither map is a {owner}, so there is nothing for {name}: leave it out.")
        if self.size > LARGEST:
            raise RangeError(f"A map cannot be {self.size} texels wide: choose {LARGEST} at most.")
        self.layout(self.target).representation.shape(self.size)

    def layout(self, name: str) -> Layout:
        """The layout of that name, with its parameters."""
        owned = [parameter for parameter, owner in PARAMETERS.items() if owner == name]
        given = {parameter: getattr(self, parameter) for parameter in owned}
        return layout(name, **{parameter: value for parameter, value in given.items() if value is not None})


PARAMETERS = {"overscan": "dual_paraboloid", "distance": "mirror_ball"}
"""Parameter -> the layout that it belongs to."""


def convert(source: Path, settings: ConvertSettings, output: Path, force: bool = False) -> Steps[list[Path]]:
    """Convert a map.

    Parameters
    ----------
    source : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone; of maps with a file
        for each sheet NAME.exr for NAME-SHEET.exr.
    settings : ConvertSettings
    output : Path
        NAME.exr or NAME.hdr.
    force : bool
        Whether existing files are replaced.

    Yields
    ------
    Progress

    Returns
    -------
    list of Path
        The files that were written.

    Raises
    ------
    InputFileError
        A file is missing or unreadable, its size does not fit the layout, or it holds no finite
        value.
    OutputFileError
        A file cannot be written, or exists and is not to be replaced.
    RangeError
        The values do not fit into Radiance HDR, or the map into this machine's memory.

    Warns
    -----
    RsibrWarning
        See `core.environment.usable_radiance`.
    """
    before, after = settings.layout(settings.source), settings.layout(settings.target)
    check_map_target(output, after, force)
    sheets, height, width = after.representation.shape(settings.size)
    check_memory(BYTES_OF_TEXEL * sheets * height * width, str(output), (width, height))
    yield Progress(0, 3, f"reading {source.name}")
    image = read_map(source, before, partial(read_light, clamp=settings.clamp))
    yield Progress(1, 3, f"making {output.name}")
    if settings.source == settings.target == "equirect" and image.shape[2] == settings.size:
        made = image
    else:
        made = resample(image, before.representation, after.representation, settings.size, np.float32)
    del image
    yield Progress(2, 3, f"writing {output.name}")
    return write_map(output, after, made, force)

"""Pictures of light in whatever format they come."""

from contextlib import suppress
from pathlib import Path

from ...core.conventions import Array
from ...core.environment import usable_radiance
from ...core.errors import InputFileError
from ...files.map_pictures import fitting_layouts
from ...files.photographs import read_photograph
from ...files.picture_facts import GREY
from ...files.pictures import split_layer
from ...files.radiance_pictures import describe_radiance, holds_radiance, read_radiance
from ...files.read_once import read_once

NO_RADIANCE = (
    "This picture holds no radiance: its lamps end at white. Give OpenEXR or Radiance HDR, or make one of it."
)


NO_ENVIRONMENT = "is {}x{}, and an environment is twice as wide as high: convert it."


@read_once
def offered_layouts(path: Path) -> tuple[str, ...]:
    """Layouts that a picture of light may have, if it is no latitude-longitude map: by its header alone.

    Parameters
    ----------
    path : Path
        FILE, or FILE.exr:LAYER.

    Returns
    -------
    tuple of str
        See `fitting_layouts`.
    """
    with suppress(InputFileError):
        fitting = fitting_layouts(split_layer(path)[0], describe_radiance(path).size)
        return () if "equirect" in fitting else fitting
    return ()


@read_once
def light_remarks(path: Path) -> tuple[str, ...]:
    """Remarks on a picture of light before a bake, by its header alone.

    Parameters
    ----------
    path : Path
        FILE, or FILE.exr:LAYER.

    Returns
    -------
    tuple of str
        Sentences; none of a picture of radiance in colour all of whose header is used.
    """
    try:
        if not holds_radiance(path):
            return (NO_RADIANCE,)
        facts = describe_radiance(path)
    except InputFileError as error:
        return (str(error),)
    grey = ["is grey: its light has no colour."] if facts.colours == GREY else []
    width, height = facts.size
    shape = [] if width == 2 * height else [NO_ENVIRONMENT.format(width, height)]
    return tuple(f"{path.name} {remark}" for remark in (*grey, *shape, *facts.remarks))


def read_light(path: Path, clamp: float | None = None) -> Array:
    """Read a picture as radiance.

    Parameters
    ----------
    path : Path
        OpenEXR or Radiance HDR, or a picture of 8 or 16 bits, whose curve is undone.
    clamp : float, optional
        See `usable_radiance`.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Linear Rec. 709, at least 0, row 0 at the bottom.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, or holds no finite value.

    Warns
    -----
    RsibrWarning
        See `usable_radiance` and `read_photograph`.
    """
    if holds_radiance(path):
        return usable_radiance(read_radiance(path), path.name, clamp)
    return usable_radiance(read_photograph(path).radiance(), path.name, clamp)

"""An environment from six photographs: [Miller1984] section 5.1, the first way."""

from functools import partial
from pathlib import Path

import numpy as np

from ...core.conventions import Array
from ...core.errors import InputFileError, RangeError
from ...core.light.cube_balance import balancing_gains
from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.map_pictures import layout, read_map
from ...files.radiance_pictures import check_radiance_target, holds_radiance
from ...settings.environment import FacesSettings
from .light_pictures import read_light
from .scaling import write_scaled

SATURATED = 0.96
"""Share of a photograph's white, in linear light (250 of 255): brighter pixels tell no exposure."""


def illuminate_from_faces(
    source: Path, settings: FacesSettings, output: Path, force: bool = False
) -> Steps[Array]:
    """Put an environment together from a cube's faces.

    Parameters
    ----------
    source : Path
        NAME.jpg for NAME-px.jpg and so on: see `files.map_pictures` and its `cube_faces`.

    Returns
    -------
    ndarray, shape (6, 3)
        What each photograph was multiplied by.

    Raises
    ------
    InputFileError
        A photograph is missing, unreadable, not square or not of the others' size; or they cannot be
        balanced.
    """
    faces, equirect = layout("cube_faces"), representation("equirect")
    check_radiance_target(output, force, faces.paths(source))
    yield Progress(0, 3, f"reading {source.name}")
    cube = read_map(source, faces, partial(read_light, clamp=settings.clamp)).astype(np.float64)
    gains: Array = np.ones((6, 3))
    is_radiance = holds_radiance(faces.paths(source)[0])
    if settings.balance:
        white = np.inf if is_radiance else SATURATED
        try:
            gains = balancing_gains(cube, white)
        except RangeError as error:
            raise InputFileError(f"{source} as six photographs: {error}") from error
    yield Progress(1, 3, f"making {output.name}")
    made = resample(cube * gains[:, None, None], faces.representation, equirect, settings.size)
    yield Progress(2, 3, f"writing {output.name}")
    write_scaled(output, made[0], settings, force, cut_off=not is_radiance)
    return gains

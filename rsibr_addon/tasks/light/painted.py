"""An environment from a painted picture: [Miller1984] section 5.3."""

from pathlib import Path

from ...core.conventions import Array
from ...core.errors import InputFileError
from ...core.light.painted import lift_whites
from ...core.maps.representation import representation
from ...core.progress import Progress, Steps
from ...core.resample import resample
from ...files.map_pictures import layout, read_map
from ...files.radiance_pictures import check_radiance_target, holds_radiance
from ...settings.environment import PaintedSettings
from .light_pictures import read_light
from .scaling import write_scaled


def illuminate_from_painting(
    source: Path, settings: PaintedSettings, output: Path, force: bool = False
) -> Steps[Path]:
    """Make an environment of a picture whose whites are lamps.

    Parameters
    ----------
    source : Path
        A picture of 8 or 16 bits, whose curve is undone; for several sheets see `files.map_pictures`.

    Raises
    ------
    InputFileError
        A file is missing, no picture or radiance already, or its size does not fit the layout.
    RangeError
        See `lift_whites`.
    """
    before, after = layout(settings.source_layout), representation("equirect")
    check_radiance_target(output, force, before.paths(source))
    yield Progress(0, 3, f"reading {source.name}")
    picture = read_map(source, before, _read_painting)
    yield Progress(1, 3, f"making {output.name}")
    # Lifted first: the mean of a lamp and its surroundings is not a lamp
    radiance = lift_whites(picture, settings.white, settings.knee)
    made = resample(radiance, before.representation, after, settings.size)
    yield Progress(2, 3, f"writing {output.name}")
    write_scaled(output, made[0], settings, force)
    return output


def _read_painting(path: Path) -> Array:
    if holds_radiance(path):
        raise InputFileError(
            f"{path} holds radiance already: use rsibr convert, or give a picture of 8 or 16 bits."
        )
    return read_light(path)

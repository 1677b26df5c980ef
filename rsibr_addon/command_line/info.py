"""The command `rsibr info`."""

import argparse
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from .console import Console


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare what `run` reads."""
    parser.add_argument(
        "file",
        metavar="NAME.rsibr.exr|PICTURE",
        help="a map set, or a picture: OpenEXR (FILE.exr:LAYER for a layer), Radiance HDR, or a photograph",
    )


def run(arguments: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Read a file, check all of it, and tell what it is.

    Returns
    -------
    dict
        For a map set: "map_set", the path, "header", the description as docs/map-set-format.md has it, and
        "suns", what docs/export.md says of its suns, or None.
        For a picture: "picture", the path; "light", the fields of `core.light.light_range.LightRange`; and of
        one of radiance "facts", those of `files.picture_facts.PictureFacts`. Of a photograph "facts" are
        "bits", "size", "turned" (by its Exif), "colours", "exposure", the fields of
        `files.exif.Exposure` or None, and "is_radiance".

    Raises
    ------
    InputFileError
        The file cannot be read: see `read_map_set`, `read_radiance` and `read_photograph`.
    RangeError
        It is too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        Something that a picture's header says is not used; says what.
    """
    from ..files.kinds.environment import is_environment
    from ..files.radiance_pictures import holds_radiance

    if is_environment(Path(arguments.file)):
        return _tell_of_radiance(arguments.file, console)
    if holds_radiance(arguments.file):
        return _tell_of_map_set(arguments.file, console)
    return _tell_of_photograph(arguments.file, console)


def _tell_of_radiance(path: str, console: Console) -> dict[str, Any]:
    from ..files.radiance_pictures import describe_radiance, read_radiance

    facts = describe_radiance(path)
    console.say(f"{path}: {facts.format}, {_size(facts.size)}")
    for name, value in (
        ("window", facts.window),
        ("channels", facts.channels),
        ("layers", ", ".join(facts.layers) or "one, without a name"),
        ("colours", facts.colours),
        ("exposure", facts.exposure),
        ("comments", facts.comments),
    ):
        if value:
            console.say(f"  {name:<12} {value}")
    if facts.size[0] != 2 * facts.size[1]:
        console.say(
            "  layout       not twice as wide as high, which an environment is: rsibr convert makes one"
        )
    return {"picture": path, "facts": asdict(facts), "light": _light(read_radiance(path), console)}


def _tell_of_photograph(path: str, console: Console) -> dict[str, Any]:
    from ..files.orientation import Orientation
    from ..files.photographs import orientation_of, read_photograph

    photograph, turned = read_photograph(path), orientation_of(path) != Orientation()
    height, width = photograph.stored.shape[:2]
    console.say(f"{path}: {8 * photograph.stored.itemsize} bits a colour, {width}x{height}")
    if turned:
        console.say("  turned       upright, as its Exif says")
    console.say(f"  colours      {photograph.encoding.name}")
    exposure = _exposure(path)
    console.say(f"  exposure     {_exposure_in_words(exposure)}")
    if photograph.encoding.curves is not None:
        why = "lamps end at white, and no scale is known"
        console.say(f"  radiance     none: {why}; rsibr illuminate makes some of it")
    facts = {
        "bits": 8 * photograph.stored.itemsize,
        "size": [width, height],
        "turned": turned,
        "colours": photograph.encoding.name,
        "exposure": exposure and asdict(exposure),
        "is_radiance": photograph.encoding.curves is None,
    }
    return {"picture": path, "facts": facts, "light": _light(photograph.radiance(), console)}


def _exposure(path: str) -> Any:
    from ..core.errors import InputFileError
    from ..files.exif import read_exposure

    try:
        return read_exposure(path)
    except InputFileError:
        return None


def _exposure_in_words(told: Any) -> str:
    if told is None:
        return "not told"
    f_number = f", f/{told.f_number:.3g}" if told.f_number else ""
    return f"{told.time:.4g} s{f_number}" + (f", ISO {told.sensitivity:g}" if told.sensitivity else "")


def _light(picture: Any, console: Console) -> dict[str, Any]:
    from ..core.light.light_range import light_range

    light = light_range(picture)
    console.say(f"  light        peak {light.peak:.4g}, mean {light.mean:.4g}, dark end {light.dark_end:.4g}")
    console.say(
        f"  values       {light.black} black, {light.negative} negative, {light.infinite} infinite, "
        f"{light.undefined} undefined (NaN)"
    )
    return asdict(light)


def _tell_of_map_set(path: str, console: Console) -> dict[str, Any]:
    from ..files.kinds.registry import STORED
    from ..files.map_set import read_map_set, read_map_set_header
    from ..files.map_set_facts import told_errors, told_facts, told_making

    held = read_map_set(path)
    header, suns = read_map_set_header(path), STORED[held.kind].suns(held)
    console.say(f"{path}: a map set, format {header['format']}")
    facts = told_facts(header) | told_errors(header) | told_making(header) | _suns_in_words(suns)
    width = max(map(len, facts))
    for what, which in facts.items():
        console.say(f"  {what:<{width}}  {which}")
    return {"map_set": path, "header": header, "suns": suns}


def _suns_in_words(suns: dict[str, Any] | None) -> dict[str, str]:
    told = {}
    for number, sun in enumerate(suns["each"] if suns else (), 1):
        direction, irradiance = (
            " ".join(f"{value:.4g}" for value in sun[what]) for what in ("direction", "irradiance")
        )
        told[f"Sun {number}"] = (
            f"direction {direction}, irradiance {irradiance}, {100.0 * sun['share']:.2g} % of the light"
        )
    return told


def _size(size: Sequence[int]) -> str:
    return "{}x{}".format(*size)

"""Single pictures as OpenEXR."""

import re
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, ShapeError
from ..core.warned import warn
from .atomic import written_aside
from .chromaticities import XYZ, rec709_from
from .exr import OpenExr, open_exr, read_attributes, write_parts
from .exr_header import Meaning, meaning
from .exr_layers import Layer, choose, layers_of
from .exr_part import Part, in_display_window, window_size
from .map_set_mark import ATTRIBUTE
from .picture_facts import GREY, PictureFacts


def write_exr(path: str | Path, rgba: Array, force: bool = False) -> None:
    """Write a picture as OpenEXR with channels R, G, B, A in float, ZIP-compressed.

    Parameters
    ----------
    path : str or Path
    rgba : ndarray, shape (height, width, 4)
        Premultiplied scene-linear Rec. 709 radiance and coverage, row 0 at the bottom.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    ShapeError
        `rgba` has another shape.
    OutputFileError
        See `written_aside`.
    """
    if rgba.ndim != 3 or rgba.shape[2] != 4:
        raise ShapeError(f"{path} takes a picture of shape (height, width, 4), not {rgba.shape}.")
    with written_aside(path, force) as aside:
        put_exr(aside, rgba)


def put_exr(path: Path, rgba: Array) -> None:
    """Write RGBA, shape (height, width, 4), under its own name at once: in a folder that is written aside."""
    pixels = rgba.astype(np.float32)
    write_parts(path, [Part("", {"RGBA": pixels})])


def read_exr(path: str | Path) -> Array:
    """Read the picture of an OpenEXR file.

    Parameters
    ----------
    path : str or Path
        Scanlines or tiles, any compression, half or float, one part or several. Its channels are R, G and B,
        or Y, RY and BY, or X, Y and Z of CIE, or Y alone, and perhaps A, in small or capital letters; without
        a layer, or in the one that renderers use for the picture: `exr_layers.choose`. FILE.exr:LAYER names
        another.

    Returns
    -------
    ndarray, shape (height, width, channels), float32
        Grey (1 channel), RGB (3) or RGBA (4), row 0 at the bottom, linear Rec. 709: where the file
        states other chromaticities, they are converted.

    Raises
    ------
    InputFileError
        See `read_parts`; or there is no colour, or it lies in several layers, or beside the picture.
    RangeError
        It is too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        A statement of the header is not used; the message names it.
    """
    with open_exr(split_layer(path)[0]) as file:
        return picture_of(path, file)


def picture_of(path: str | Path, file: OpenExr) -> Array:
    """The picture of an open file: see `read_exr`, whose `path` names it."""
    layer, meant, remarks = _chosen(path, file.headers)
    for remark in remarks:
        warn(f"{path} {remark}")
    part = file.parts()[layer.part]
    wanted = {role: name for role, name in layer.channels.items() if part.channels[name].dtype.kind == "f"}
    if wanted.keys() | {"A"} != layer.channels.keys() | {"A"}:
        raise InputFileError(
            f"{path} holds no colour but whole numbers ({', '.join(layer.channels.values())}): "
            f"save it in float or half."
        )
    picture = Part(part.name, {role: part.channels[name] for role, name in wanted.items()}, part.attributes)
    placed = in_display_window(path, picture)
    return _rec709_picture(placed.channels, meant)


def split_layer(path: str | Path) -> tuple[Path, str | None]:
    """A file, and the named layer in it.

    Parameters
    ----------
    path : str or Path
        FILE, or FILE.exr:LAYER; a file with just this name takes precedence.

    Returns
    -------
    Path
    str or None
    """
    named = LAYER_OF_FILE.fullmatch(str(path))
    if named is None or Path(path).is_file():
        return Path(path), None
    return Path(named[1]), named[2]


def describe_exr(path: str | Path) -> PictureFacts:
    """Describe the use of an OpenEXR file from its headers alone.

    Parameters
    ----------
    path : str or Path
        As `read_exr` takes it.

    Raises
    ------
    InputFileError
        As `read_exr`, except for the pixels.
    """
    headers = read_attributes(split_layer(path)[0])
    layer, meant, remarks = _chosen(path, headers)
    header = headers[layer.part]
    return PictureFacts(
        format="OpenEXR",
        size=window_size(header["displayWindow"]),
        window=" to ".join("{},{}".format(*corner) for corner in header["dataWindow"]),
        channels=", ".join(layer.channels.values()),
        layers=tuple(other.name for other in layers_of(headers) if other.name),
        colours=GREY if layer.is_grey else meant.colours,
        exposure="none stated",
        comments=str(header.get("comments", "")),
        remarks=tuple(remarks),
    )


LAYER_OF_FILE = re.compile(r"(.+\.exr):([^:/\\]+)", re.IGNORECASE | re.DOTALL)


def _chosen(path: str | Path, headers: list[dict[str, Any]]) -> tuple[Layer, Meaning, list[str]]:
    """A file's picture, its meaning, and the rest of the file."""
    file, wanted = split_layer(path)
    if headers and ATTRIBUTE in headers[0]:
        raise InputFileError(f"{path} is a map set, not a picture: give the picture that it was made of.")
    layers = layers_of(headers)
    if not layers:
        found = ", ".join(sorted({channel.name for header in headers for channel in header["channels"]}))
        raise InputFileError(
            f"{path} holds no colour (channels: {found[:200] or 'none'}): "
            f"save it with R, G and B in float or half."
        )
    layer, left = choose(file, layers, wanted)
    meant = meaning(headers[layer.part])
    if "X" in layer.channels:
        left.append("has channels X, Y and Z, which are taken as CIE XYZ.")
    if layer.left:
        left.append(
            f"has {', '.join(layer.left)} beside {layer.channels['Y']}, but not the other channels of a "
            f"colour: it is taken as grey."
        )
    return layer, meant, [*left, *meant.remarks]


def _rec709_picture(channels: dict[str, Array], meant: Meaning) -> Array:
    """The picture of channels by their role."""
    matrix = meant.matrix
    if "RY" in channels:
        channels = channels | _from_chroma(channels, meant.luminance_weights.astype(np.float32))
    elif "X" in channels:
        channels = channels | {"R": channels["X"], "G": channels["Y"], "B": channels["Z"]}
        matrix = rec709_from(XYZ)
    roles = [role for role in "RGBA" if role in channels] if "R" in channels else ["Y"]
    pixels = Part("", channels).side_by_side(roles).astype(np.float32, copy=False)
    if len(roles) >= 3 and not np.array_equal(matrix, np.eye(3)):
        with np.errstate(over="ignore", invalid="ignore"):  # from values that are already infinite
            for row in pixels:
                row[:, :3] = row[:, :3] @ matrix.T.astype(np.float32)
    return pixels


def _from_chroma(channels: dict[str, Array], weights: Array) -> dict[str, Array]:
    """R, G and B, whose luminance is Y with `weights`, from the chromas (R - Y) / Y and (B - Y) / Y."""
    luminance = channels["Y"].astype(np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        red, blue = ((channels[chroma] + np.float32(1.0)) * luminance for chroma in ("RY", "BY"))
        green = (luminance - weights[0] * red - weights[2] * blue) / weights[1]
    return {"R": red, "G": green, "B": blue}

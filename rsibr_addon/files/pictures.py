"""Single pictures as OpenEXR."""

from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError, ShapeError
from .atomic import written_aside
from .chromaticities import rec709_from
from .exr import Part, in_display_window, read_parts, write_parts


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
    pixels = rgba.astype(np.float32)
    channels: dict[str, Array] = {name: pixels[..., i] for i, name in enumerate("RGBA")}
    with written_aside(path, force) as aside:
        write_parts(aside, [Part("", channels)])


def read_exr(path: str | Path) -> Array:
    """Read the first picture in colour or grey of an OpenEXR file.

    Parameters
    ----------
    path : str or Path
        Scanlines or tiles, any compression, half or float, one part or several. The channels are R, G,
        B and perhaps A, or Y alone; else those of the one layer, NAME.R and so on, that has such.

    Returns
    -------
    ndarray, shape (height, width, channels), float32
        Grey (1 channel), RGB (3) or RGBA (4), row 0 at the bottom, linear Rec. 709: where the file
        states other chromaticities, they are converted.

    Raises
    ------
    InputFileError
        See `read_parts`; or there is no colour, or it lies in several layers, or its chromaticities
        make no sense.
    """
    parts = read_parts(path)
    for part in parts:
        if names := _colour_channels(path, part):
            try:
                return _rec709_picture(path, in_display_window(part), names)
            except MemoryError as error:
                raise InputFileError(f"{path} is too large for this machine's memory: shrink it.") from error
    found = ", ".join(sorted({name for part in parts for name in part.channels})) or "none"
    raise InputFileError(
        f"{path} holds no colour (channels: {found}): save it with R, G and B in float or half."
    )


def _colour_channels(path: str | Path, part: Part) -> list[str]:
    """The names of the channels to show, in order; empty where there are none."""
    floats = {name for name, pixels in part.channels.items() if pixels.dtype.kind == "f"}
    if floats.issuperset("RGB"):
        return list("RGBA" if "A" in floats else "RGB")
    if "Y" in floats:
        return ["Y"]
    prefixes = {name.rpartition(".")[0] for name in floats if "." in name}
    layers = sorted(prefix for prefix in prefixes if floats >= {f"{prefix}.{c}" for c in "RGB"})
    if len(layers) > 1:
        raise InputFileError(f"{path} holds several layers ({', '.join(layers)}): save the one to be used.")
    return [f"{layer}.{c}" for layer in layers for c in "RGBA" if f"{layer}.{c}" in floats]


def _rec709_picture(path: str | Path, part: Part, names: list[str]) -> Array:
    pixels = np.stack([part.channels[name] for name in names], axis=-1).astype(np.float32)
    if len(names) >= 3 and "chromaticities" in part.attributes:
        try:
            matrix = rec709_from(part.attributes["chromaticities"])
        except (TypeError, ValueError) as error:  # TypeError: they are no numbers at all
            raise InputFileError(
                f"{path} cannot be converted to Rec. 709 ({error}): save it again."
            ) from error
        pixels[..., :3] = pixels[..., :3] @ matrix.T
    return pixels

"""Pictures of radiance in either format: OpenEXR and Radiance HDR."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.errors import InputFileError
from . import exr, radiance_hdr
from .apart import check_apart
from .atomic import check_target, written_aside
from .exr_part import Part
from .picture_facts import PictureFacts
from .pictures import describe_exr, picture_of, split_layer
from .reading import opened

NEITHER = "is neither OpenEXR nor Radiance HDR: give one, or make light of photographs by rsibr illuminate."

_LONGEST_MAGIC = max(len(exr.MAGIC), len(radiance_hdr.MAGIC))


def holds_radiance(path: str | Path) -> bool:
    """Whether a file is OpenEXR or Radiance HDR, by its first bytes.

    Raises
    ------
    InputFileError
        The file is missing or unreadable.
    """
    return _start(path).startswith((exr.MAGIC, radiance_hdr.MAGIC))


def read_radiance(path: str | Path) -> Array:
    """Read a picture of radiance.

    Parameters
    ----------
    path : str or Path
        OpenEXR or Radiance HDR, recognised by its first bytes, not by its name; FILE.exr:LAYER for a layer.

    Returns
    -------
    ndarray, shape (height, width, 3), float32
        Linear Rec. 709, row 0 at the bottom; may be negative, NaN or infinite.

    Raises
    ------
    InputFileError
        The file is missing, unreadable, of another format, truncated or damaged, or has no colour.
    RangeError
        It is too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        A statement of the header is not used; the message names it.
    """
    file = split_layer(path)[0]
    with opened(file) as stream:
        start = stream.read(_LONGEST_MAGIC)
        if start.startswith(exr.MAGIC):
            pixels = picture_of(path, exr.OpenExr(file, stream))[..., :3]
        elif start.startswith(radiance_hdr.MAGIC):
            pixels = radiance_hdr.read_hdr(path)
        else:
            raise InputFileError(f"{path} {NEITHER}")
    height, width = pixels.shape[:2]
    return np.broadcast_to(pixels, (height, width, 3))


def describe_radiance(path: str | Path) -> PictureFacts:
    """Describe the use of a picture of radiance, named as for `read_radiance`, from its header alone.

    Raises
    ------
    InputFileError
        As `read_radiance`, except for the pixels.
    """
    start = _start(path)
    if start.startswith(exr.MAGIC):
        return describe_exr(path)
    if not start.startswith(radiance_hdr.MAGIC):
        raise InputFileError(f"{path} {NEITHER}")
    header = radiance_hdr.read_hdr_header(path)
    factors = " ".join(f"{factor:.6g}" for factor in header.scale)
    return PictureFacts(
        format="Radiance HDR",
        size=header.size,
        window="all",
        channels="RGBE",
        layers=(),
        colours=header.colours,
        exposure="none stated" if np.all(header.scale == 1.0) else f"{factors}, divided out",
        comments=header.comments,
        remarks=header.remarks,
    )


def check_radiance_target(path: str | Path, force: bool = False, sources: Iterable[Path] = ()) -> None:
    """Refuse a name that `write_radiance` would refuse, unless it may be replaced, before long work begins.

    Parameters
    ----------
    sources : iterable of Path
        Files that the picture is made of.

    Raises
    ------
    OutputFileError
        The name ends neither in .exr nor in .hdr; or see `check_target` and `check_apart`.
    """
    check_target(path, force, (".exr", ".hdr"))
    check_apart(path, sources)


def write_radiance(path: str | Path, radiance: Array, force: bool = False, comments: str = "") -> None:
    """Write a picture of radiance.

    Parameters
    ----------
    path : str or Path
        NAME.exr for OpenEXR with R, G and B in float, NAME.hdr for Radiance HDR.
    radiance : ndarray, shape (height, width, 3)
        Linear Rec. 709, row 0 at the bottom.
    force : bool
        Whether an existing file is replaced.
    comments : str
        A line that the header states.

    Raises
    ------
    OutputFileError
        See `check_radiance_target` and `written_aside`.
    RangeError
        Radiance HDR cannot hold the values: see `write_hdr`.
    """
    check_radiance_target(path, force)
    if Path(path).suffix.lower() == ".hdr":
        radiance_hdr.write_hdr(path, radiance, force, comments)
        return
    pixels = radiance.astype(np.float32, copy=False)
    with written_aside(path, force) as aside:
        exr.write_parts(aside, [Part("", {"RGB": pixels}, {"comments": comments} if comments else {})])


def _start(path: str | Path) -> bytes:
    with opened(split_layer(path)[0]) as stream:
        return stream.read(_LONGEST_MAGIC)

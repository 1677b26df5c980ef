"""Prefiltered cubes as Babylon.js's .env: a mark, JSON that ends with a zero, and PNGs of all faces."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..core.conventions import Array
from ..core.rgbd import rgbd_from_radiance
from .atomic import written_aside
from .png import png_of

MARK = bytes((0x86, 0x16, 0x87, 0x96, 0xF6, 0xD6, 0x96, 0x36))


def rgbd_faces(mips: Sequence[Array]) -> list[bytes]:
    """The PNGs of a cube, face by face of the largest mip, then of the next.

    Parameters
    ----------
    mips : sequence of ndarray, shape (6, n, n, 3)
        Faces of `core.maps.cube_map`, from 0 to `core.rgbd.LARGEST`.

    Returns
    -------
    list of bytes
        Their first row is the last of the face: Babylon.js turns them over.
    """
    return [png_of(rgbd_from_radiance(face[::-1].astype(np.float64))) for faces in mips for face in faces]


def write_env(
    path: str | Path,
    mips: Sequence[Array],
    irradiance: dict[str, list[float]],
    scale: float,
    force: bool = False,
) -> None:
    """Write a cube with its diffuse light.

    Parameters
    ----------
    path : str or Path
        Usually NAME.env.
    mips : sequence of ndarray, shape (6, n, n, 3)
        All mips down to a texel: see `rgbd_faces`.
    irradiance : dict
        Colours of Babylon.js's polynomial, of x, y, z, xx, yy, zz, yz, zx and xy.
    scale : float
        Mips for each doubling of alpha.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        See `written_aside`.

    Notes
    -----
    Version 1 of the format, which all versions of Babylon.js read.
    """
    pictures = rgbd_faces(mips)
    ends = np.cumsum([0, *(len(picture) for picture in pictures)]).tolist()
    places = [
        {"length": len(picture), "position": place} for picture, place in zip(pictures, ends, strict=False)
    ]
    manifest = {
        "version": 1,
        "width": mips[0].shape[1],
        "irradiance": irradiance,
        "specular": {"mipmaps": places, "lodGenerationScale": scale},
    }
    with written_aside(path, force) as aside:
        aside.write_bytes(MARK + json.dumps(manifest).encode() + b"\0" + b"".join(pictures))

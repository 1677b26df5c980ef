"""Tensor files of the RGL material database."""

import struct
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..core.brdf.measured_rgl import MeasuredRgl
from ..core.conventions import Array
from ..core.errors import InputFileError, ShapeError
from ..core.warned import warn
from .reading import opened

MAGIC = b"tensor_file\0"
VERSION = (1, 0)
TYPES = {
    1: "u1",
    2: "i1",
    3: "<u2",
    4: "<i2",
    5: "<u4",
    6: "<i4",
    7: "<u8",
    8: "<i8",
    9: "<f2",
    10: "<f4",
    11: "<f8",
}
LARGEST = 1 << 30
"""Most bytes of a field; the largest of the database's RGB files has 20 MB in all."""

FIELDS = ("phi_i", "theta_i", "sigma", "ndf", "vndf", "rgb", "jacobian")


def read_rgl(path: str | Path) -> MeasuredRgl:
    """Read an isotropic measurement of the RGL database, in its RGB form.

    Parameters
    ----------
    path : str or Path
        A `_rgb.bsdf` file.

    Returns
    -------
    MeasuredRgl
        Its spec is `rgl:path=` and the path.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, of another format or version, truncated or damaged, lacks a field
        (spectral files have no RGB), is anisotropic, holds NaN or infinite values, or fields that do
        not fit together.

    Warns
    -----
    RsibrWarning
        Reflectance is negative, as for colours outside Rec. 709, and taken as 0; the message counts the
        values.
    """
    fields = _checked_fields(path)
    if negative := int(np.count_nonzero(fields["rgb"] < 0.0)):
        warn(f"{path} has {negative} values of colours outside Rec. 709; they are taken as 0.")
    try:
        # All azimuths of an isotropic measurement are equal: the first is used
        return MeasuredRgl(
            theta_v=fields["theta_i"].ravel(),
            sigma=fields["sigma"][0],
            ndf=fields["ndf"][0],
            vndf=fields["vndf"][0],
            weight=np.maximum(fields["rgb"][0], 0.0),
            spec=f"rgl:path={path}",
        )
    except (ShapeError, IndexError) as error:
        raise InputFileError(f"{path} has unfit fields ({error}): fetch it again.") from error


def _checked_fields(path: str | Path) -> dict[str, Array]:
    """The `FIELDS` of an isotropic RGB measurement, float64, with checked values; shapes are not checked."""
    tensors = read_tensors(path)
    if missing := [name for name in FIELDS if name not in tensors]:
        raise InputFileError(f"{path} has no field {', '.join(missing)}: give an RGB file (_rgb.bsdf).")
    if tensors["phi_i"].size > 2:
        raise InputFileError(f"{path} is anisotropic, which lobes cannot follow: give an isotropic material.")
    if not np.all(tensors["jacobian"] == 1):
        raise InputFileError(f"{path} is of an unknown scale (jacobian 0): give the database's current file.")
    with np.errstate(invalid="ignore"):  # NaN of the signalling kind
        fields: dict[str, Array] = {name: tensors[name].astype(np.float64) for name in FIELDS}
    if unusable := sum(int(np.count_nonzero(~np.isfinite(field))) for field in fields.values()):
        raise InputFileError(f"{path} holds {unusable} values that are NaN or infinite: fetch it again.")
    negative_density = any((fields[name] < 0.0).any() for name in ("ndf", "vndf"))
    seen = (fields["sigma"] > 0.0).all() and fields["vndf"].any(axis=(-2, -1)).all()
    if negative_density or not seen:
        raise InputFileError(f"{path} has views with no visible normals: fetch it again.")
    return fields


def read_tensors(path: str | Path) -> dict[str, Array]:
    """Read all fields of a tensor file.

    Returns
    -------
    dict
        Field -> array of the shape and type that the file states.

    Raises
    ------
    InputFileError
        The file is missing or unreadable, of another format or version, truncated or damaged.

    Notes
    -----
    [Dupuy2018], supplement: a directory of names, types, offsets and shapes, then the data.
    """
    with opened(path) as stream:
        if stream.read(len(MAGIC)) != MAGIC:
            raise InputFileError(f"{path} is no tensor file of the RGL database: give another.")
        try:
            version = _unpack(stream, "2B")
            if version != VERSION:
                raise InputFileError(
                    f"{path} is a tensor file of version {version[0]}.{version[1]}; only 1.0 can be read."
                )
            (count,) = _unpack(stream, "I")
            directory = [_read_entry(stream) for _ in range(count)]
            return {name: _read_field(stream, *place) for name, place in directory}
        except (EOFError, KeyError, UnicodeDecodeError, ValueError) as error:
            raise InputFileError(f"{path} is truncated or damaged ({error}): fetch it again.") from error


def _unpack(stream: BinaryIO, layout: str) -> tuple[int, ...]:
    return struct.unpack("<" + layout, _read(stream, struct.calcsize("<" + layout)))


def _read(stream: BinaryIO, count: int) -> bytes:
    data = stream.read(count)
    if len(data) != count:
        raise EOFError("it ends too early")
    return data


def _read_entry(stream: BinaryIO) -> tuple[str, tuple[str, int, tuple[int, ...]]]:
    """Name of a field; and its type, place and shape."""
    (length,) = _unpack(stream, "H")
    name = _read(stream, length).decode()
    dimensions, kind, offset = _unpack(stream, "HBQ")
    if kind not in TYPES:
        raise ValueError(f"its field {name!r:.40} is of unknown type {kind}")
    return name, (TYPES[kind], offset, _unpack(stream, f"{dimensions}Q"))


def _read_field(stream: BinaryIO, kind: str, offset: int, shape: tuple[int, ...]) -> Array:
    dtype = np.dtype(kind)
    count = 1
    for extent in shape:
        count *= extent
    if count * dtype.itemsize > LARGEST:
        raise ValueError(f"a field of shape {shape} is too large")
    stream.seek(offset)
    return np.frombuffer(_read(stream, count * dtype.itemsize), dtype).reshape(shape)

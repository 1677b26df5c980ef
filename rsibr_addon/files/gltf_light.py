"""Image-based light in glTF 2.0: the extension EXT_lights_image_based, in a file without anything else."""

import base64
import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..core.conventions import Array
from .atomic import written_aside
from .babylon_env import rgbd_faces

EXTENSION = "EXT_lights_image_based"


def write_gltf_light(
    path: str | Path,
    mips: Sequence[Array],
    coefficients: Array,
    name: str,
    software: str,
    force: bool = False,
) -> None:
    """Write a light, and a scene that it lights.

    Parameters
    ----------
    path : str or Path
        NAME.glb, or NAME.gltf, which holds the pictures as text.
    mips : sequence of ndarray, shape (6, n, n, 3)
        See `babylon_env.rgbd_faces`.
    coefficients : ndarray, shape (9, 3)
        Of the irradiance, in the order of `core.filtering.irradiance.real_harmonics`.
    name, software : str
        What the light is called, and what made it.
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    OutputFileError
        See `written_aside`.
    """
    pictures = [picture + bytes(-len(picture) % 4) for picture in rgbd_faces(mips)]
    data = b"".join(pictures)
    starts = np.cumsum([0, *(len(picture) for picture in pictures)])[:-1].tolist()
    light = {
        "name": name,
        "intensity": 1.0,
        "irradianceCoefficients": coefficients.tolist(),
        "specularImageSize": mips[0].shape[1],
        "specularImages": np.arange(len(pictures)).reshape(-1, 6).tolist(),
    }
    described: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": software},
        "extensionsUsed": [EXTENSION],
        "extensions": {EXTENSION: {"lights": [light]}},
        "scene": 0,
        "scenes": [{"name": name, "extensions": {EXTENSION: {"light": 0}}}],
        "images": [
            {"bufferView": view, "mimeType": "image/png", "name": f"mip {view // 6} face {view % 6}"}
            for view in range(len(pictures))
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": len(picture)}
            for start, picture in zip(starts, pictures, strict=True)
        ],
        "buffers": [{"byteLength": len(data)}],
    }
    with written_aside(path, force) as aside:
        aside.write_bytes(_glb(described, data) if aside.suffix.lower() == ".glb" else _gltf(described, data))


def _glb(described: dict[str, Any], data: bytes) -> bytes:
    text = json.dumps(described).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4s2I", b"glTF", 2, 12 + len(chunks)) + chunks


def _gltf(described: dict[str, Any], data: bytes) -> bytes:
    inside = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    described["buffers"][0]["uri"] = inside
    return json.dumps(described).encode()

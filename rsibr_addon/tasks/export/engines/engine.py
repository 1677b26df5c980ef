"""What an engine takes, and the light as it takes it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ....core import packed_floats, rgbd
from ....core.bc6h import encode as bc6h
from ....core.conventions import Array
from ....core.half_floats import half_holds
from ....core.warned import warn
from .settings import CubeSettings, EngineSettings

Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Directions of glTF and of engines with Y up, from Blender's."""

MIRRORED_X = np.diag([-1.0, 1.0, 1.0])
"""For engines that look cubes up by (-x, y, z)."""

MIRRORED_Z = np.diag([1.0, 1.0, -1.0])
"""For engines that look cubes up by (x, y, -z)."""


@dataclass(frozen=True)
class Encoding:
    """How texels hold radiance.

    Attributes
    ----------
    name : str
    largest : float
        Radiance that is cut to.
    darkest : float
        Radiance below which texels err by more of it than above.
    """

    name: str
    largest: float
    darkest: float


BC6H = Encoding("BC6H", bc6h.LARGEST, bc6h.DARKEST)
R11F_G11F_B10F = Encoding("R11F_G11F_B10F", packed_floats.LARGEST, packed_floats.DARKEST)
RGBD = Encoding("RGBD", rgbd.LARGEST, rgbd.DARKEST)

LARGEST_HALF = float(np.finfo(np.float16).max)


@dataclass(frozen=True)
class EngineLight:
    """Light as an engine takes it.

    Attributes
    ----------
    name : str
        The environment's.
    software : str
        What made it, in words.
    mips : tuple of ndarray, shape (6, n, n, 3), float32
        Radiance on the faces of `core.maps.cube_map`, in the axes of the engine's texture.
    diffuse : ndarray, shape (6, n, n, 3), float32, or None
        Irradiance over pi, likewise; None where the engine takes none.
    roughness : tuple of float
        Of each mip.
    harmonics : ndarray, shape (9, 3), float64
        Coefficients of radiance in the order of `core.filtering.irradiance.real_harmonics`, likewise.
    """

    name: str
    software: str
    mips: tuple[Array, ...]
    diffuse: Array | None
    roughness: tuple[float, ...]
    harmonics: Array


Write = Callable[[EngineLight, Path, bool], list[Path]]
"""Light, the output, and whether existing files are replaced, to the files that were written."""


@dataclass(frozen=True, kw_only=True)
class Preset:
    """What is said of an engine.

    Attributes
    ----------
    label : str
        The engine's own name.
    use : str
        What to do with the file there, as a phrase in one line.
    beside : str
        What the name of a second file has more than the first one's; empty where there is none.
    """

    label: str
    use: str
    beside: str = ""

    def files_of(self, output: Path) -> list[Path]:
        """The files that an export to `output` writes."""
        second = output.with_stem(output.stem + self.beside)
        return list(dict.fromkeys((output, second)))


@dataclass(frozen=True, kw_only=True)
class CubeEngine(Preset):
    """An engine that takes light filtered, as a cube.

    Attributes
    ----------
    axes : ndarray, shape (3, 3)
        Directions by which the engine's textures are looked up, from Blender's; may mirror.
    roughness : callable
        Width of the first mip to the roughness of each mip: see `core.kinds.mip_chain.ggx`.
    least : int
        Smallest width of the first mip.
    writers : mapping of str to callable
        Ending -> what writes the file; the usual one first.
    diffuse : int
        Width of the cube of diffuse light that it takes; 0 for none.
    settings : type
        What can be chosen of it.
    """

    axes: Array
    roughness: Callable[[int], tuple[float, ...]]
    least: int
    writers: Mapping[str, Write]
    diffuse: int = 0
    settings: type[CubeSettings] = CubeSettings

    @property
    def endings(self) -> tuple[str, ...]:
        """Endings of its files' names, in small letters, the usual one first."""
        return tuple(self.writers)

    def chosen(self, settings: Any) -> "CubeEngine":
        """The engine with what was chosen of it besides a size."""
        return self


@dataclass(frozen=True, kw_only=True)
class PanoramaEngine(Preset):
    """An engine that filters light itself, from a latitude-longitude picture.

    Attributes
    ----------
    quarters : int
        By how many quarters of its width a picture of Blender's is moved to the left.
    """

    endings: ClassVar[tuple[str, ...]] = (".exr", ".hdr")
    settings: ClassVar[type[EngineSettings]] = EngineSettings

    quarters: int


def mips_down_to(size: int, last: int) -> int:
    """Number of mips from faces of `size` texels to faces of `last`; both are powers of 2."""
    return (size // last).bit_length()


def as_halves(mips: tuple[Array, ...], name: str) -> tuple[Array, ...]:
    """The mips, as half floats can hold them; for engines that cannot interpolate 32-bit floats everywhere.

    Parameters
    ----------
    mips : tuple of ndarray, shape (6, n, n, 3)
    name : str
        The light in words.

    Warns
    -----
    RsibrWarning
        Something was cut, or is so dark that it loses precision.
    """
    cut = _cut(mips, name, "a half float", LARGEST_HALF)
    if not half_holds(cut):
        warn(f"{name} is so dark that half floats round it by more than a thousandth: make it brighter.")
    return cut


def within(mips: tuple[Array, ...], name: str, encoding: Encoding) -> tuple[Array, ...]:
    """The mips, with what an encoding cannot hold cut to its largest value.

    Parameters
    ----------
    mips : tuple of ndarray, shape (6, n, n, 3)
    name : str
        The light in words.
    encoding : Encoding

    Warns
    -----
    RsibrWarning
        Something was cut, or the mean is so dark that it loses precision.
    """
    mean = float(np.mean(mips[0], dtype=np.float64))
    if 0.0 < mean < encoding.darkest:
        warn(
            f"{name} has a mean radiance of {mean:.2g}, and {encoding.name} is coarse below "
            f"{encoding.darkest:.2g}: make it brighter."
        )
    return _cut(mips, name, encoding.name, encoding.largest)


def _cut(mips: tuple[Array, ...], name: str, encoding: str, largest: float) -> tuple[Array, ...]:
    brightest = max(float(faces.max()) for faces in mips)
    if brightest <= largest:
        return mips
    warn(
        f"{name} has radiance up to {brightest:g}, and {encoding} ends at {largest:g}: what is brighter is "
        f"cut, so clamp the environment, or make its sun a lamp."
    )
    return tuple(np.minimum(faces, np.float32(largest)) for faces in mips)

"""The light of a map set or of a picture, filtered by an engine's own rule and written for it."""

from pathlib import Path

import numpy as np

from ....core.conventions import Array
from ....core.environment import Environment
from ....core.errors import OutputFileError, RangeError
from ....core.filtering.irradiance import turned_harmonics
from ....core.kinds.kernel_pyramid.bake import bake_pyramid
from ....core.kinds.kernel_pyramid.pyramid import Pyramid
from ....core.kinds.mip_chain.ggx import ggx_mips
from ....core.maps import cube_map
from ....core.progress import Progress, Steps
from ....files.apart import check_apart
from ....files.atomic import check_target
from ....files.kinds import environment, kernel_pyramid, mip_chain
from ....files.kinds.kernel_pyramid import shipped_families
from ....files.map_set import read_map_set
from ....files.map_set_data import MapSet
from ....files.outputs import together
from ....files.radiance_pictures import write_radiance
from ....files.version import rsibr
from . import lobes
from .engine import CubeEngine, EngineLight, PanoramaEngine
from .engines import ENGINES
from .lobes import LobesEngine
from .settings import CubeSettings, EngineSettings, LobesSettings

SIZE = 256
"""Width of the first mip of a cube, if no mip chain says it."""

WIDEST = 512
"""Width of the sharpest maps of kernels, if no kernel pyramid says it."""

ROUGHEST = (1.0,)
"""The lobe of this roughness is the cosine over pi, so that its mip is the diffuse light."""


def export_for_engine(
    source: Path, output: Path, name: str, settings: EngineSettings | None = None, force: bool = False
) -> Steps[list[Path]]:
    """Write light for an engine, into one file or several; all files appear, or none.

    Parameters
    ----------
    source : Path
        A map set, whose environment is filtered again by the engine's rule, but a kernel pyramid is taken as
        it is for lobes; or a picture of an environment.
    output : Path
        Its suffix is one of the engine's.
    name : str
        The engine, one of `ENGINES`.

    Raises
    ------
    MapSetError, InputFileError
        The source cannot be read, or does not hold its environment.
    RangeError
        The size is too small for the engine, or a width is asked of a kernel pyramid, which has its own.
    OutputFileError
        The name is not one of the engine's, or a file exists.

    Warns
    -----
    RsibrWarning
        Something is brighter than the engine's texels can be.
    """
    engine = ENGINES[name]
    asked = settings or engine.settings()
    if output.suffix.lower() not in engine.endings:
        known = " or ".join(engine.endings)
        raise OutputFileError(
            f"{output} does not end in {known}, as {engine.label} wants: give a name that does."
        )
    for path in engine.files_of(output):
        check_target(path, force)
        check_apart(path, [source])
    yield Progress(0, 1, f"reading {source.name}")
    held = _read(source)
    light = environment.from_map_set(source, held)
    match engine, asked:
        case CubeEngine(), CubeSettings(size=size):
            chosen = engine.chosen(asked)
            filtered = yield from _filtered(light, chosen, size or _size_of(source, held))
            with together():
                return chosen.writers[output.suffix.lower()](filtered, output, force)
        case LobesEngine(), LobesSettings(widest=width):
            pyramid = yield from _pyramid(source, held, light, width)
            with together():
                return lobes.write(pyramid, shipped_families(), light.name, output, force)
        case PanoramaEngine(), _:
            moved = np.roll(light.radiance, -engine.quarters * light.radiance.shape[1] // 4, axis=1)
            write_radiance(output, moved, force)
    return [output]


def _pyramid(source: Path, held: MapSet, light: Environment, width: int | None) -> Steps[Pyramid]:
    if held.kind == kernel_pyramid.KIND:
        if width is not None:
            raise RangeError(f"{source} has maps of its own widths, which stay: bake it in another size.")
        return kernel_pyramid.from_map_set(source, held)
    baked = yield from bake_pyramid(light.radiance, width or WIDEST)
    return baked.pyramid


def _filtered(light: Environment, engine: CubeEngine, size: int) -> Steps[EngineLight]:
    if size < engine.least:
        raise RangeError(
            f"{engine.label} takes cubes from {engine.least} texels on, not of {size}: enlarge it."
        )
    roughness = engine.roughness(size)
    mips = []
    filtered = ggx_mips(light.radiance, size, roughness, degree=2)
    for number in range(len(roughness)):
        yield Progress(1 + number, len(roughness) + 2, f"filtering mip {number} for {engine.label}")
        mips.append(_turned(next(filtered.mips).faces, engine))
    diffuse = None
    if engine.diffuse:
        diffuse = _turned(next(ggx_mips(light.radiance, engine.diffuse, ROUGHEST).mips).faces, engine)
    harmonics = turned_harmonics(filtered.harmonics.real(2), engine.axes)
    yield Progress(len(roughness) + 1, len(roughness) + 2, f"writing for {engine.label}")
    return EngineLight(light.name, rsibr(), tuple(mips), diffuse, roughness, harmonics)


def _read(source: Path) -> MapSet:
    if environment.is_environment(source):
        return environment.read_as_map_set(source)
    return read_map_set(source)


def _size_of(source: Path, held: MapSet) -> int:
    return mip_chain.from_map_set(source, held).size if held.kind == mip_chain.KIND else SIZE


def _turned(faces: Array, engine: CubeEngine) -> Array:
    return cube_map.turned(faces.astype(np.float32), engine.axes)

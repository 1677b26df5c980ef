"""Light that no turn and no mirror takes to itself, and what an engine must show of it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import CubeSettings

RNG = np.random.default_rng(3)
EQUIRECT = representation("equirect")
LAMPS = (
    ((1.0, 0.2, 0.1), 30.0, (3.0, 0.4, 0.1)),
    ((-0.2, 1.0, 0.3), 12.0, (0.2, 2.0, 0.5)),
    ((0.1, -0.3, 1.0), 6.0, (0.6, 1.0, 2.5)),
    ((-0.7, -0.7, -0.2), 80.0, (4.0, 4.0, 1.0)),
)
"""Direction in Blender's world, sharpness, and colour."""

SUM = 1e-3
"""Of the brightest: to what mips are filtered; harmonics lose a little of the widest lobes' kink."""


def sky(height: int = 128) -> np.ndarray:
    """A latitude-longitude map of smooth light."""
    direction = EQUIRECT.texel_directions(2 * height)[0]
    radiance = np.full(direction.shape, 0.1)
    for axis, sharpness, colour in LAMPS:
        cosine = direction @ (np.array(axis) / np.linalg.norm(axis))
        radiance += np.exp(sharpness * (cosine - 1.0))[..., None] * colour
    return radiance.astype(np.float32)


def sky_file(folder: Path) -> Path:
    """The same as a picture."""
    write_radiance(folder / "sky.exr", sky())
    return folder / "sky.exr"


def truth(direction: np.ndarray, roughness: float) -> np.ndarray:
    """What a mip of a roughness shows in directions of Blender's world: the sum over all texels."""
    if roughness == 0.0:
        return lookup(sky()[None], direction, EQUIRECT)
    return prefilter_exact(sky(), [ggx_n_dot_l_lobe(roughness**2)], direction)[0]


def diffuse_truth(normal: np.ndarray) -> np.ndarray:
    """What a white matte surface reflects."""
    return irradiance_exact(sky(), normal) / np.pi


def from_y_up(direction: np.ndarray) -> np.ndarray:
    """Directions of Blender's world, from those of glTF: what points to -Z there points to +Y here."""
    x, y, z = np.moveaxis(direction, -1, 0)
    return np.stack([x, -z, y], axis=-1)


def cube_directions(size: int) -> np.ndarray:
    """Directions of a cube's texels, shape (6, size, size, 3), as OpenGL finds them: table 8.19.

    Written anew, so that a slip in ours would be found.
    """
    s = (2.0 * np.arange(size) + 1.0) / size - 1.0
    t, s = np.meshgrid(s, s, indexing="ij")
    one = np.ones_like(s)
    faces = [(one, -t, -s), (-one, -t, s), (s, one, t), (s, -one, -t), (s, -t, one), (-s, -t, -one)]
    directions = np.stack([np.stack(face, axis=-1) for face in faces])
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


def exported(folder: Path, engine: str, ending: str) -> list[Path]:
    """The files that an engine gets of it, of 64 texels."""
    output = folder / f"sky{ending}"
    return drain(export_for_engine(sky_file(folder), output, engine, CubeSettings(size=64)))


def some_texels(size: int) -> np.ndarray:
    """Indices of at most 100 texels of a cube, shape (3, n)."""
    texels = np.indices((6, size, size)).reshape(3, -1)
    return texels[:, RNG.permutation(texels.shape[1])[:100]]


def check_cube(
    levels: list[np.ndarray],
    roughness: list[float],
    world: Callable[[np.ndarray], np.ndarray],
    relative: np.ndarray | float,
) -> None:
    """Hold every level to the truth; `world` makes directions of Blender's from the texture's."""
    assert len(levels) == len(roughness)
    for faces, rough in zip(levels, roughness, strict=True):
        at = some_texels(faces.shape[1])
        wanted = truth(world(cube_directions(faces.shape[1])[*at]), rough)
        error = np.abs(faces[*at] - wanted)
        assert np.all(error <= relative * wanted + SUM * wanted.max()), (rough, (error / wanted).max())


def from_mirrored_x(direction: np.ndarray) -> np.ndarray:
    """What three.js and Babylon.js look up by (-x, y, z)."""
    return from_y_up(direction * (-1.0, 1.0, 1.0))

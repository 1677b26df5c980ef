"""Any engine, beyond the split sum: light in kernels, the lobes of GGX, and shaders that sum them up.

A surface of glTF's metallic-roughness model is shaded as `core.kinds.kernel_pyramid.shading` shades it: a
dielectric of index 1.5 over a diffuse base, mixed with a metal of Schlick's Fresnel term.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from string import Template
from typing import Any, ClassVar

import numpy as np

from ....core.brdf.fresnel_powers import POWERS, rise
from ....core.conventions import Array
from ....core.kinds.kernel_pyramid.atlas import atlas_texels
from ....core.kinds.kernel_pyramid.pyramid import Pyramid
from ....core.kinds.kernel_pyramid.shading import Families
from ....core.lobes.family import KERNELS
from ....core.suns import Suns
from ....files.atomic import written_aside
from ....files.ktx2 import Texels, write_ktx2
from ....files.textures import Texture
from ....files.version import rsibr
from .engine import LARGEST_HALF, Preset, as_halves
from .settings import LobesSettings

LANGUAGES = {".glsl": "vec{}", ".wgsl": "vec{}f", ".hlsl": "float{}"}
"""Ending of a shader -> the type of so many numbers in its language."""

F0 = 0.04
"""Of glTF's dielectrics, whose index of refraction is 1.5."""

FUNCTIONS = ("white", "Schlick's rise", "rise of glass")
"""For each kernel, the lobes' weights in GGX without a Fresnel term, times (1 - cos)^5, and times what brings
the exact term of glass from F0 to 1."""


@dataclass(frozen=True, kw_only=True)
class LobesEngine(Preset):
    """Shaders that an engine's own material takes in."""

    endings: ClassVar[tuple[str, ...]] = (".ktx2",)
    settings: ClassVar[type[LobesSettings]] = LobesSettings

    def files_of(self, output: Path) -> list[Path]:
        """The files that an export to `output` writes."""
        return [*super().files_of(output), *(output.with_suffix(ending) for ending in LANGUAGES)]


ENGINE = LobesEngine(
    label="Lobes",
    use="shade with NAME.glsl, .wgsl or .hlsl from NAME.ktx2 and NAME-lobes.ktx2 instead of the split sum",
    beside="-lobes",
)


def write(pyramid: Pyramid, families: Families, name: str, output: Path, force: bool) -> list[Path]:
    """Write the light, the lobes and the shaders.

    Parameters
    ----------
    pyramid : Pyramid
    families : Families
    name : str
        The light's.
    output : Path
        NAME.ktx2.

    Returns
    -------
    list of Path
        See `LobesEngine.files_of`.

    Warns
    -----
    RsibrWarning
        Light is brighter than half floats are.
    """
    files = ENGINE.files_of(output)
    suns = pyramid.suns
    if not suns.mirror_share(families.ggx.alpha[0]):  # nothing shows them as a mirror does
        below = np.minimum(pyramid.mirror, suns.ceiling).astype(np.float32)
        pyramid = replace(pyramid, mirror=below)
    atlas, places = atlas_texels(pyramid)
    families = replace(families, ggx=pyramid.resolved(families.ggx))
    notes = {"KTXwriter": rsibr()}
    levels = as_halves((atlas[None, ..., :3],), name)
    write_ktx2(files[0], Texture(levels), notes, force, Texels.HALF)
    write_ktx2(files[1], Texture((lobe_table(families),)), notes, force, Texels.HALF)
    used = places[0, : len(KERNELS) + 2]  # the mirror and diffuse light are behind the kernels
    for path in files[2:]:
        constants = _constants(used, suns, LANGUAGES[path.suffix])
        alpha = families.ggx.alpha
        constants |= {"widths": len(alpha), "an_octave": round(np.log(2.0) / np.log(alpha[1] / alpha[0]))}
        constants |= {"resolved": len(pyramid.bank)}
        shader = Template(Path(__file__).with_suffix(path.suffix).read_text(encoding="utf-8"))
        with written_aside(path, force) as aside:
            aside.write_text(shader.substitute(name=output.stem, **constants), encoding="utf-8")
    return files


def _constants(places: Array, suns: Suns, vector: str) -> dict[str, Any]:
    """What a shader says of places and suns; `vector` is one of `LANGUAGES`."""

    def told(numbers: Array) -> str:
        return f"{vector.format(len(numbers))}({', '.join(f'{number:.9g}' for number in numbers)})"

    def listed(vectors: Array) -> str:
        return ",\n    ".join(map(told, vectors))

    none = np.zeros((0 if len(suns) else 1, 3))  # no language has empty arrays
    return {
        "kernels": len(KERNELS),
        "places": listed(places),
        "suns": len(suns),
        "directions": listed(np.vstack([suns.direction, none])),
        "irradiances": listed(np.vstack([suns.irradiance, none])),
        "ceiling": told(np.minimum(suns.ceiling, LARGEST_HALF)),
        "narrowest": suns.narrowest,
        "glass": told(rise(np.sqrt(F0))[1:]),
    }


def lobe_table(families: Families) -> Array:
    """The lobes of GGX by width and elevation.

    Returns
    -------
    ndarray, shape (2 + 3 * K, S, A, 4), float32
        A row for each elevation, a column for each width. The tilts of four lobes; for each kernel and each
        of `FUNCTIONS` the weights of these lobes; the albedos of the functions, and the mean of the first.
    """
    ggx = families.ggx
    glass = rise(np.sqrt(F0))
    # Functions of `POWERS` to ours: 1, (1 - cos)^5, and all that glass has
    ours = np.zeros((ggx.weights.shape[4], len(FUNCTIONS)))
    ours[0, 0], ours[POWERS.index(5), 1], ours[:, 2] = 1.0, 1.0, glass
    weights = np.einsum("asjkc,cf->kfsaj", ggx.weights.astype(np.float64), ours)
    # Albedos are those of the weights as half floats hold them, so that white metal stays white
    weights = weights.astype(np.float16).astype(np.float64)
    albedo = np.moveaxis(weights.sum(axis=(0, 4)), 0, -1)
    mean = np.broadcast_to(families.mean(ggx.alpha), albedo.shape[:2])[..., None]
    layers = [
        ggx.tilts.swapaxes(0, 1)[None],
        weights.reshape(-1, *weights.shape[2:]),
        np.concatenate([albedo, mean], axis=-1)[None],
    ]
    table: Array = np.concatenate(layers).astype(np.float32)
    return table

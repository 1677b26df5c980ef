"""Bevy: two KTX 2.0 cubes, of specular and of diffuse light."""

from pathlib import Path

from ....core.kinds.mip_chain.ggx import linear_roughness
from ....files.ktx2 import Texels, write_ktx2
from ....files.textures import Texture
from .engine import MIRRORED_Z, Y_UP, CubeEngine, EngineLight, as_halves, mips_down_to

LAST = 8
"""Width of the last mip: four texels to a quarter turn hold the widest lobe."""


def write(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.ktx2 and NAME-diffuse.ktx2: see `CubeEngine.writers`."""
    assert light.diffuse is not None
    files = ENGINE.files_of(output)
    for path, mips in zip(files, (light.mips, (light.diffuse,)), strict=True):
        texture = Texture(as_halves(mips, light.name), is_cube=True)
        write_ktx2(path, texture, {"KTXwriter": light.software}, force, Texels.HALF)
    return files


ENGINE = CubeEngine(
    label="Bevy",
    use="give EnvironmentMapLight NAME.ktx2 as specular_map, NAME-diffuse.ktx2 as diffuse_map",
    beside="-diffuse",
    axes=MIRRORED_Z @ Y_UP,
    roughness=lambda size: linear_roughness(mips_down_to(size, LAST)),
    least=2 * LAST,
    writers={".ktx2": write},
    diffuse=32,
)

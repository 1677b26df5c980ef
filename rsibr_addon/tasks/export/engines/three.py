"""three.js: the cube that its own prefilter makes, compressed or not."""

from pathlib import Path

from ....core.kinds.mip_chain.ggx import quadratic_roughness
from ....files.dds import write_dds
from ....files.ktx2 import Texels, write_ktx2
from ....files.textures import Texture
from .engine import BC6H, MIRRORED_X, Y_UP, CubeEngine, EngineLight, as_halves, mips_down_to, within

LAST = 8
"""Width of the last mip, that of roughness 1, from which diffuse light comes too."""


def write_compressed(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.dds: see `CubeEngine.writers`."""
    write_dds(output, within(light.mips, light.name, BC6H), compressed=True, force=force)
    return [output]


def write_uncompressed(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.ktx2: see `CubeEngine.writers`."""
    mips = as_halves(light.mips, light.name)
    write_ktx2(output, Texture(mips, is_cube=True), {"KTXwriter": light.software}, force, Texels.HALF)
    return [output]


ENGINE = CubeEngine(
    label="three.js",
    use="set it as scene.environment, by the loader on the page three.js of the documentation",
    axes=MIRRORED_X @ Y_UP,
    roughness=lambda size: quadratic_roughness(mips_down_to(size, LAST)),
    least=2 * LAST,
    writers={".dds": write_compressed, ".ktx2": write_uncompressed},
)

"""Filament: KTX 1 as its tool cmgen writes it, with the irradiance as a text, and a sky beside."""

from pathlib import Path

from ....core.filtering.irradiance import diffuse_terms
from ....core.kinds.mip_chain.ggx import quadratic_roughness
from ....files.ktx1 import write_ktx1
from .engine import R11F_G11F_B10F, Y_UP, CubeEngine, EngineLight, mips_down_to, within

LAST = 16
"""Width of the last mip, which cmgen ends at."""


def write(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.ktx and NAME-skybox.ktx: see `CubeEngine.writers`."""
    mips = within(light.mips, light.name, R11F_G11F_B10F)
    # Rows of the text are terms, its columns colours
    terms = "".join(
        " ".join(f"{value:.6g}" for value in row) + "\n" for row in diffuse_terms(light.harmonics)
    )
    light_file, sky = files = ENGINE.files_of(output)
    write_ktx1(light_file, mips, {"sh": terms}, force)
    write_ktx1(sky, mips[:1], {}, force)
    return files


ENGINE = CubeEngine(
    label="Filament",
    use="load NAME.ktx and NAME-skybox.ktx with ktxreader::Ktx1Reader, or KTX1Loader on Android",
    beside="-skybox",
    axes=Y_UP,
    roughness=lambda size: quadratic_roughness(mips_down_to(size, LAST)),
    least=2 * LAST,
    writers={".ktx": write},
)

"""An engine that has no preset: the user says how it looks cubes up."""

import json
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ....core.kinds.mip_chain.ggx import ROUGHNESS_RULES
from ....files.dds import write_dds
from ....files.ktx2 import Texels, write_ktx2
from ....files.textures import Texture, Up
from .engine import (
    BC6H,
    MIRRORED_X,
    MIRRORED_Z,
    Y_UP,
    CubeEngine,
    EngineLight,
    as_halves,
    mips_down_to,
    within,
)
from .settings import AnySettings

AXES = {Up.Z: np.eye(3), Up.Y: Y_UP}
MIRRORS = {"none": np.eye(3), "x": MIRRORED_X, "y": np.diag([1.0, -1.0, 1.0]), "z": MIRRORED_Z}


def write_as_ktx2(settings: AnySettings, light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.ktx2, with what a shader has to know: see `CubeEngine.writers`."""
    note = {
        "up": settings.up.value,
        "mirror": settings.mirror,
        "roughness": light.roughness,
        "harmonics": light.harmonics.tolist(),
    }
    texels = Texels.BC6H if settings.texels == "bc6h" else Texels.FITTING
    mips = within(light.mips, light.name, BC6H) if texels is Texels.BC6H else light.mips
    notes = {"KTXwriter": light.software, "rsibr": json.dumps(note, allow_nan=False)}
    write_ktx2(output, Texture(mips, is_cube=True), notes, force, texels)
    return [output]


def write_as_dds(settings: AnySettings, light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.dds: see `CubeEngine.writers`."""
    compressed = settings.texels == "bc6h"
    mips = within(light.mips, light.name, BC6H) if compressed else as_halves(light.mips, light.name)
    write_dds(output, mips, compressed, force)
    return [output]


@dataclass(frozen=True, kw_only=True)
class AnyEngine(CubeEngine):
    """Takes what is asked for."""

    def chosen(self, settings: AnySettings) -> CubeEngine:
        """See `CubeEngine`."""
        return _asked_for(settings)


def _asked_for(settings: AnySettings) -> AnyEngine:
    rule = ROUGHNESS_RULES[settings.rule]
    return AnyEngine(
        label="Any",
        use="look the cube up as was chosen: the page on any engine of the documentation has the lines",
        settings=AnySettings,
        axes=MIRRORS[settings.mirror] @ AXES[settings.up],
        roughness=lambda size: rule(mips_down_to(size, settings.last)),
        least=2 * settings.last,
        writers={".ktx2": partial(write_as_ktx2, settings), ".dds": partial(write_as_dds, settings)},
    )


ENGINE = _asked_for(AnySettings())

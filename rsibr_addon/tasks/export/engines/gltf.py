"""glTF with the extension EXT_lights_image_based, as Babylon.js reads it."""

from pathlib import Path

import numpy as np

from ....core.filtering.irradiance import irradiance_coefficients
from ....core.kinds.mip_chain.ggx import linear_roughness
from ....files.gltf_light import write_gltf_light
from .engine import MIRRORED_X, RGBD, Y_UP, CubeEngine, EngineLight, mips_down_to, within

LAST = 16
"""Width of the last mip, which the extension suggests."""

SIGNS = np.array([1, -1, 1, -1, 1, -1, 1, -1, 1])[:, None]
"""Of the harmonics as Babylon.js has them, from ours: those of odd order are negative."""


def write(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.glb or NAME.gltf: see `CubeEngine.writers`."""
    mips = within(light.mips, light.name, RGBD)
    coefficients = SIGNS * irradiance_coefficients(light.harmonics)
    write_gltf_light(output, mips, coefficients, light.name, light.software, force)
    return [output]


ENGINE = CubeEngine(
    label="glTF",
    use="load it as a scene in Babylon.js, and set linearSpecularLOD of its environmentTexture",
    axes=MIRRORED_X @ Y_UP,
    roughness=lambda size: linear_roughness(mips_down_to(size, LAST)),
    least=2 * LAST,
    writers={".glb": write, ".gltf": write},
)

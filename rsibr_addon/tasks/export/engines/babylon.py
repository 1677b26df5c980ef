"""Babylon.js: its own .env, whose cube holds RGBD and whose diffuse light is a polynomial of the normal."""

from pathlib import Path

from ....core.conventions import Array
from ....core.filtering.irradiance import diffuse_terms
from ....files.babylon_env import write_env
from .engine import MIRRORED_X, RGBD, Y_UP, CubeEngine, EngineLight, mips_down_to, within

SCALE = 0.8
"""Mips for each doubling of alpha, as its shader has it unless a file says otherwise."""


def roughness(size: int) -> tuple[float, ...]:
    """The environment itself, then alpha = 2^(mip / `SCALE`) / size up to 1, down to a texel."""
    alphas = (min(2.0 ** (mip / SCALE) / size, 1.0) for mip in range(1, mips_down_to(size, 1)))
    return (0.0, *(alpha**0.5 for alpha in alphas))


def polynomial(harmonics: Array) -> dict[str, list[float]]:
    """Colours of the products of the normal's components, as Babylon.js takes them.

    Parameters
    ----------
    harmonics : ndarray, shape (9, 3)
        See `EngineLight`.

    Notes
    -----
    Babylon.js makes harmonics of the polynomial and draws by those: `SphericalPolynomial.preScaledHarmonics`.
    On the way it takes linear terms times 3/2, xy, yz and zx times 4, 3 z^2 - 1 of zz - (xx + yy) / 2
    times 4/3, and x^2 - y^2 of xx - yy times 2. Divided by these, the light is exact; drawn by the polynomial
    itself, as with `useSphericalHarmonics` off, it would be smoother.
    """
    one, y, z, x, xy, yz, zz, zx, xx_yy = diffuse_terms(harmonics)
    colours = {
        "x": x / 1.5,
        "y": y / 1.5,
        "z": z / 1.5,
        "xx": one - zz / 4.0 + xx_yy / 4.0,
        "yy": one - zz / 4.0 - xx_yy / 4.0,
        "zz": one + zz / 2.0,
        "yz": yz / 4.0,
        "zx": zx / 4.0,
        "xy": xy / 4.0,
    }
    return {name: colour.tolist() for name, colour in colours.items()}


def write(light: EngineLight, output: Path, force: bool) -> list[Path]:
    """Write NAME.env: see `CubeEngine.writers`."""
    mips = within(light.mips, light.name, RGBD)
    write_env(output, mips, polynomial(light.harmonics), SCALE, force)
    return [output]


ENGINE = CubeEngine(
    label="Babylon.js",
    use="make a CubeTexture of it, and set that as scene.environmentTexture",
    axes=MIRRORED_X @ Y_UP,
    roughness=roughness,
    least=16,
    writers={".env": write},
)

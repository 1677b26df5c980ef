"""Measure GGX mip chains, ours and cmgen's: CPU time, errors against the sum over texels, lean of the lobe.

Filament's tool cmgen is in Debian's package libfilament-tools; without it only our column is measured. Prints
a Markdown table, and writes it into docs/mip-chains.md if both were measured.
"""

import resource
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import OpenEXR
from bench_prefilter import cpu_seconds, environment
from docs_table import write_table
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe
from rsibr.rsibr_addon.core.kinds.mip_chain.ggx import ggx_mips, linear_roughness, quadratic_roughness
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.maps.representation import representation

SIZE = 256
ROUGHNESS = quadratic_roughness(5)
"""What cmgen makes: mips of 256 to 16 texels, by this rule."""

RUNS = 3
SAMPLES = 200
"""Texels of each mip that are compared with brute force."""

SUNS = ((300, 100), (255, 512), (420, 777))
"""Row and column of the texels that are lit, one after the other, to see whether their lobes lean."""

CUBE = representation("cube_map")
WORLD_FROM_CMGEN = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""The directions that cmgen's faces show, in our axes: found by comparing its mip 0 with the environment."""

Chain = list[Array]
Filter = Callable[[Array], Chain]


def ours(radiance: Array) -> Chain:
    """What we make."""
    return [mip.faces for mip in ggx_mips(radiance, SIZE, ROUGHNESS).mips]


def cmgen(radiance: Array) -> Chain:
    """What cmgen makes."""
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "light.exr"
        pixels = {"RGB": np.ascontiguousarray(radiance[::-1], np.float32)}
        OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION}, pixels).write(str(source))
        command = ["cmgen", "--quiet", "--format=exr", f"--size={SIZE}", f"--ibl-ld={folder}", source]
        subprocess.run(command, check=True)
        return [
            np.stack([_pixels(source.with_suffix("") / f"m{mip}_{face}.exr") for face in CUBE.sheets])
            for mip in range(len(ROUGHNESS))
        ]


def _pixels(path: Path) -> Array:
    with OpenEXR.File(str(path)) as file:
        return np.asarray(file.channels()["RGB"].pixels, np.float64)


def cpu_seconds_of_children(work: Callable[[], object]) -> float:
    """CPU time of the processes that the work starts."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    work()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def errors(chain: Chain, radiance: Array, world_from_cube: Array) -> list[float]:
    """Median relative error of each filtered mip, over some of its texels and all channels."""
    medians = []
    for mip, r in list(enumerate(ROUGHNESS))[1:]:
        directions = CUBE.texel_directions(SIZE >> mip).reshape(-1, 3) @ world_from_cube.T
        some = np.random.default_rng(mip).choice(len(directions), SAMPLES, replace=False)
        exact = prefilter_exact(radiance, [ggx_n_dot_l_lobe(r**2)], directions[some])[0]
        medians.append(float(np.median(np.abs(chain[mip].reshape(-1, 3)[some] / exact - 1.0))))
    return medians


def leans(filtered: Filter, world_from_cube: Array) -> Array:
    """Angle between a lit texel and the mean direction of its lobe, shape (suns, mips) [degrees]."""
    found = []
    height = 512
    for row, column in SUNS:
        radiance = np.zeros((height, 2 * height, 3))
        radiance[row, column] = 1e4
        sun = equirect.direction_from_uv(texel_centres(2 * height, height)[row, column])
        found.append([])
        for faces in filtered(radiance)[1:]:
            weight = faces[..., 0] * CUBE.texel_solid_angle(faces.shape[1])
            mean = np.einsum("fji,fjix->x", weight, CUBE.texel_directions(faces.shape[1]) @ world_from_cube.T)
            # Of small angles the cosine loses the digits, the sine does not.
            sine = np.linalg.norm(np.cross(mean, sun)) / np.linalg.norm(mean)
            found[-1].append(np.degrees(np.arcsin(min(sine, 1.0))))
    return np.array(found)


def row(what: str, own: str, other: str, asked: str) -> str:
    """A row of the table."""
    return f"| {what} | {own} | {other} | {asked} |"


def seconds(work: Callable[[], float]) -> float:
    """Median of some runs."""
    return float(np.median([work() for _ in range(RUNS)]))


def several(values: Sequence[float], form: str) -> str:
    """Numbers of the mips, in their order."""
    return ", ".join(format(value, form) for value in values)


def main() -> None:
    """Measure, print the table, and write it into the docs."""
    radiance = environment(1)
    installed = shutil.which("cmgen") is not None
    world = np.eye(3)
    time = seconds(lambda: cpu_seconds(lambda: ours(radiance)))
    whole = seconds(lambda: cpu_seconds(lambda: list(ggx_mips(radiance, SIZE, linear_roughness(9)).mips)))
    own_errors, own_leans = errors(ours(radiance), radiance, world), leans(ours, world)
    other_time, other_errors, other_leans, ratio = "-", "-", "-", ""
    if installed:
        chains: list[Chain] = []
        cmgen_time = cpu_seconds_of_children(lambda: chains.append(cmgen(radiance)))
        other_time, ratio = f"{cmgen_time:.1f} s", f", {time / cmgen_time:.3f} of cmgen's"
        other_errors = several([100 * e for e in errors(chains[0], radiance, WORLD_FROM_CMGEN)], ".1f") + " %"
        other_leans = several(leans(cmgen, WORLD_FROM_CMGEN).max(axis=0), ".2f") + " deg"
    table = "\n".join(
        [
            row("GGX mips of `interior`, 1024x512", "ours", "cmgen", "asked"),
            "|---|---|---|---|",
            row("CPU time, 256 to 16 texels", f"{time:.2f} s{ratio}", other_time, "0.1 of cmgen's"),
            row("CPU time, 256 to 1 texels, linear roughness", f"{whole:.2f} s", "-", ""),
            row(
                "median relative error, mips 1 to 4",
                several([100 * e for e in own_errors], ".4f") + " %",
                other_errors,
                "0.1 %",
            ),
            row(
                "lean of a lit texel's lobe, worst of three, mips 1 to 4",
                several(own_leans.max(axis=0), ".4f") + " deg",
                other_leans,
                "0.05 deg",
            ),
        ]
    )
    print(table)
    if installed:
        write_table("mip-chains.md", "mips", table)
    else:
        print("\ncmgen is not installed (Debian: libfilament-tools), so docs/mip-chains.md stays as it is.")


if __name__ == "__main__":
    main()

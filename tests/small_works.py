"""A small piece of work for each command that computes, for a process of its own: SOURCES FOLDER."""

import sys
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.ball_circle import Circle
from rsibr.rsibr_addon.core.light.ball_photograph import BallSide
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.synthetic_ball import ball_photograph, surroundings
from rsibr.tests.synthetic_camera import photograph
from rsibr.tests.written_pictures import write_png

MODEL = "ggx:alpha=0.4,metal=copper"
TURN = 120.0
"""Degrees from the one photograph of the ball to the other."""


def write_sources(folder: Path) -> None:
    """What `works` read: an environment with a sun, photographs, a painting; and a fit."""
    light = surroundings(representation("equirect").texel_directions(256)[0])
    write_png(folder / "painting.png", _encoded(0.5 * light[::4, ::4]))
    light[80:84, 60:64] = 2000.0
    write_radiance(folder / "light.exr", light)
    for turn, name in ((0.0, "ball.exr"), (TURN, "second.exr")):
        side = BallSide(np.zeros((2, 2, 3)), np.radians(turn))
        write_radiance(folder / name, ball_photograph(side, Circle(51.0, 46.0, 40.0), 100, 90, camera=0.2))
    points = np.arange(96) + 1j * np.arange(80)[:, None]
    for number, time in enumerate((0.25, 1.0, 4.0)):
        moved = points * np.exp(0.004j * number) + (2.3 - 1.7j) * number
        write_png(folder / f"bracket{number}.png", _encoded(photograph(moved, time)))
    faces = surroundings(representation("cube_map").texel_directions(16))
    for face, name in zip(faces, ("px", "nx", "py", "ny", "pz", "nz"), strict=True):
        write_radiance(folder / f"faces-{name}.exr", face)
    assert run(["fit", "--brdf", MODEL, "--lobes", "2", "--slices", "3", "-o", str(folder / "fit.json")]) == 0


def works(sources: Path) -> dict[str, tuple[str, ...]]:
    """Output's name -> the command that makes it, but for that."""
    light = ("--environment", str(sources / "light.exr"))
    fit = ("fit", "--brdf", MODEL, "--slices", "3", "--method")
    brackets = [str(sources / f"bracket{number}.png") for number in range(3)]
    second = ("--second", str(sources / "second.exr"), "--turn", str(TURN))
    return {
        "box.rsibr.exr": ("mips", *light, "--filter", "box", "--size", "32"),
        "ggx.rsibr.exr": ("mips", *light, "--filter", "ggx", "--size", "32"),
        "tables.rsibr.exr": ("tables", *light, "--material", "varnished"),
        "bank.rsibr.exr": ("bank", *light, "--size", "64"),
        "pyramid.rsibr.exr": ("bake", "kernel-pyramid", *light, "--size", "128"),
        "stack.rsibr.exr": ("bake", *light, "--fit", str(sources / "fit.json")),
        "half.rsibr.exr": ("bake", *light, "--fit", str(sources / "fit.json"), "--half"),
        "single.json": (*fit, "single"),
        "greedy.json": (*fit, "greedy", "--lobes", "2"),
        "searched.json": (*fit, "greedy", "--lobes", "2", "--seek", "places"),
        "room.exr": ("illuminate", "ball", str(sources / "ball.exr"), *second, "--size", "64"),
        "merged.exr": ("illuminate", "brackets", *brackets, "--times", "0.25,1,4"),
        "six.exr": ("illuminate", "faces", str(sources / "faces.exr"), "--balance", "--size", "64"),
        "painted.exr": ("illuminate", "painted", str(sources / "painting.png"), "--white", "20"),
    } | {
        f"{layout}.exr": ("convert", "--from", "equirect", "--to", layout, "--size", "32", light[1])
        for layout in ("mirror_ball", "octahedral", "cube_cross")
    }


def _encoded(values: np.ndarray) -> np.ndarray:
    return np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8)


if __name__ == "__main__":
    for name, command in works(Path(sys.argv[1])).items():
        output = str(Path(sys.argv[2]) / name)
        assert run([*command, *(() if command[0] == "convert" else ("-o",)), output]) == 0, command

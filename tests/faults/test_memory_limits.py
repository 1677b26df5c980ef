"""Limits on memory: every command has a result, or says in one sentence why not, and leaves nothing.

A few with the other tests; RSIBR_MOMENTS asks for all, at three sizes and three limits.
"""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.faults.processes import Running
from rsibr.tests.mirror_capture import write_mirror_capture
from rsibr.tests.written_pictures import write_png

pytestmark = [
    pytest.mark.skipif(sys.platform != "linux", reason="Linux keeps the limit"),
    pytest.mark.needs("gl", "bpy", "cycles"),
    pytest.mark.slow,
]

LOBES = "--brdf ggx:alpha=0.3,metal=gold"
COMMANDS: dict[str, tuple[str, tuple[int, int, int]]] = {
    "convert": ("convert {light} out.exr --from equirect --to cube_faces --size {n}", (32, 512, 4096)),
    "box": ("mips --environment {light} --filter box --size {n}", (32, 256, 1024)),
    "ggx": ("mips --environment {light} --filter ggx --size {n}", (32, 256, 1024)),
    "sharp": ("mips --environment {light} --roughness 0,0.05 --size {n}", (32, 256, 1024)),
    "tables": ("tables --environment {light} --material varnished --rows {n}", (16, 512, 4096)),
    "exact": ("tables --environment {small} --specular phong:ks=0.5,n=50 --exact --rows {n}", (8, 16, 4096)),
    "bank": ("bank --environment {light} --size {n}", (32, 256, 1024)),
    "pyramid": ("bake kernel-pyramid --environment {light} --size {n}", (32, 256, 2048)),
    "bake": (f"bake --environment {{light}} {LOBES} --slices 6 --size {{n}}", (16, 128, 1024)),
    "fit": (f"fit {LOBES} --lobes 2 --slices {{n}}", (3, 12, 48)),
    "export": ("export {views}", (0, 0, 0)),
    "engine": ("export {light} --for any --texels bc6h --size {n}", (32, 256, 512)),
    "report": ("report {views}", (0, 0, 0)),
    "preview": ("preview {views} --size {n}", (32, 512, 2048)),
    "compare": ("compare {stack} --views 2 --rings 8 --size {n}", (32, 128, 1024)),
    "capture": ("capture --environment {light} --material gold --samples 2 --size {n}", (16, 64, 4096)),
    "denoise": (
        "capture --environment {light} --material gold --samples 2 --denoise --size {n}",
        (16, 64, 2048),
    ),
    "illuminate faces": ("illuminate faces {faces} --size {n}", (32, 512, 8192)),
    "illuminate brackets": ("illuminate brackets {photo} {photo} --times 1,4 --curve srgb", (0, 0, 0)),
    "illuminate painted": (
        "illuminate painted {photo} --white 20 --from mirror_ball --size {n}",
        (32, 512, 4096),
    ),
    "illuminate world": ("illuminate world {blend} --size {n}", (32, 512, 8192)),
    "illuminate scene": ("illuminate scene {blend} --samples 1 --size {n}", (32, 256, 8192)),
}
"""Commands, and their sizes."""

OUTPUTS = {
    **dict.fromkeys(("mips", "tables", "bank", "bake", "capture"), "out.rsibr.exr"),
    "convert": None,
    "fit": "out.json",
    "export": "out.ktx2",
    "report": "out.html",
    "preview": "out.png",
    "compare": "out",
    "illuminate": "out.exr",
}

SIZES = "small", "usual", "large"
ROWS = dict(zip(SIZES, (64, 512, 4096), strict=True))
"""Of environments, of photographs and faces, which are square."""

IS_LONG = "RSIBR_MOMENTS" in os.environ
LIMITS = (1, 2, 3) if IS_LONG else (2,)
"""Gigabytes of addresses."""


def picture(height: int, width: int) -> np.ndarray:
    """Which packs well, shape (height, width, 3)."""
    rows, columns = np.linspace(0.0, 1.0, height)[:, None], np.linspace(0.0, 1.0, width)
    return np.stack(np.broadcast_arrays(rows.round(2), columns.round(2), 0.5), axis=-1).astype(np.float32)


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> Path:
    import bpy

    folder = tmp_path_factory.mktemp("sources")
    for size, rows in ROWS.items() if IS_LONG else [("small", ROWS["small"])]:
        light = folder / f"{size}-light.exr"
        write_radiance(light, picture(rows, 2 * rows))
        for face in ("px", "nx", "py", "ny", "pz", "nz"):
            write_radiance(folder / f"{size}-faces-{face}.exr", picture(rows, rows))
        write_png(folder / f"{size}-photo.png", (200 * picture(rows, rows)).astype(np.uint8))
        write_mirror_capture(folder / f"{size}-views.rsibr.exr", 12, min(rows, 1024))
        stack = f"bake --environment {light} {LOBES} --slices 6 --size {min(rows, 512) // 4}"
        assert run([*stack.split(), "-o", str(folder / f"{size}-stack.rsibr.exr")]) == 0
    bpy.ops.wm.read_factory_settings()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "room.blend"))
    return folder


@pytest.mark.parametrize("limit", LIMITS)
@pytest.mark.parametrize("size", SIZES if IS_LONG else SIZES[:1])
@pytest.mark.parametrize("name", COMMANDS if IS_LONG else ("convert", "bake", "preview", "capture"))
def test_a_result_or_a_sentence(name: str, size: str, limit: int, sources: Path, tmp_path: Path) -> None:
    text, sizes = COMMANDS[name]
    given = {
        each: sources / f"{size}-{each}{suffix}"
        for each, suffix in (("light", ".exr"), ("views", ".rsibr.exr"), ("stack", ".rsibr.exr"))
    } | {
        "small": sources / "small-light.exr",
        "faces": sources / f"{size}-faces.exr",
        "photo": sources / f"{size}-photo.png",
        "blend": sources / "room.blend",
        "n": sizes[SIZES.index(size)],
    }
    argv = text.format(**given).split()
    output = OUTPUTS[argv[0]]
    ended = Running(tmp_path, *argv, *(("-o", output) if output else ()), addresses=limit * 10**9).end()
    assert ended.temporary == []
    *warnings, last = ended.err.splitlines() or [""]
    assert all(line.startswith("rsibr: warning: ") for line in warnings), ended.err
    if ended.code == 0:
        assert last == "" or last.startswith("rsibr: warning: ")
        assert ended.left
        return
    # Memory of others may be free another time
    assert ended.code in (1, 75)
    assert last.startswith("rsibr: error: ")
    assert any(word in last for word in ("memory", "addresses", "choose", "shrink")), last
    # A capture's finished views are kept
    assert ended.left <= {"out.rsibr.exr.partial"}

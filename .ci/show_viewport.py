"""Show the scene of `show_render` in the window, previews beside Cycles; writes docs/images/viewport.jpg.

It needs the Blender that `.ci/window/blender install` makes, and the extension that `make extension` builds.
"""

import argparse
import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import bpy
from docs_table import DOCS
from show_render import build

ROOT = Path(__file__).parents[1]
BLENDER_WINDOW = ROOT / ".ci" / "window" / "blender"
IN_WINDOW = [ROOT / "tests" / "gui" / name for name in ("in_window.py", "xshot.py")]

PLACES = {
    "Ball": (-0.8, 0.9, 0.0),
    "Suzanne": (0.45, -0.4, 0.0),
    "Vase": (1.75, -0.3, -0.1),
    "Cushion": (3.0, 0.2, -0.2),
}
"""Suzanne is on the line."""

SCENARIO = """
import sys
sys.path.insert(0, "/job")
from in_window import *

SECONDS_OF_CYCLES = 240.0
LINE = 0.35

def scenario(told):
    bpy.ops.wm.open_mainfile(filepath="/job/scene.blend", load_ui=False)
    yield
    area, scene = view(), bpy.context.scene
    space, shown = area.spaces.active, window()
    space.show_region_ui = True
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    space.overlay.show_cursor = space.overlay.show_outline_selected = space.overlay.show_extras = False
    space.shading.type = "RENDERED"
    scene.render.engine = "CYCLES"
    scene.cycles.preview_samples, scene.cycles.use_preview_denoising = 32, True
    turn = space.region_3d
    turn.view_perspective, turn.view_distance, turn.view_location = "PERSP", 6.7, (1.6, 0.0, -0.1)
    turn.view_rotation = (0.75, 0.66, 0.02, 0.03)
    bpy.context.view_layer.objects.active = bpy.data.objects["Suzanne"]
    yield from drawn()
    next(each for each in area.regions if each.type == "UI").active_panel_category = "RSIBR"
    with bpy.context.temp_override(window=shown, area=area, region=region(area)):
        told["preview"] = list(bpy.ops.rsibr.preview_scene("INVOKE_DEFAULT"))
    while session().bakes.busy:
        yield
    split = bpy.context.window_manager.rsibr_view
    split.split, split.line = True, LINE
    yield from drawn()
    begun = time.monotonic()
    while time.monotonic() < begun + SECONDS_OF_CYCLES:
        yield
    yield from drawn()
    told["messages"] = session().previews.messages(bpy.context.object)
    picture = xshot.grab()
    top = picture.shape[0] - area.y - area.height
    xshot.save(picture[top : top + area.height, area.x : area.x + area.width], "/job/window.png")

run(scenario)
"""


def main() -> None:
    """Draw the window, and write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--image", type=Path, default=DOCS / "images" / "viewport.jpg")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        job = Path(name)
        scene = build(job)
        for item, place in PLACES.items():
            scene.objects[item].location = place
        bpy.ops.file.pack_all()
        bpy.ops.wm.save_mainfile()
        (extension,) = (ROOT / "dist").glob("rsibr-*.zip")
        for each in (*IN_WINDOW, extension):
            shutil.copy(each, job)
        run(
            job,
            "--command",
            "extension",
            "install-file",
            "-r",
            "user_default",
            "-e",
            f"/job/{extension.name}",
        )
        said = run(job, "--window", "--enable-event-simulate", "--python-expr", SCENARIO)
        told = json.loads(said.split("TOLD ", 1)[1].splitlines()[0])
        if "error" in told or told["messages"]:
            raise SystemExit(str(told))
        settings = scene.render.image_settings
        settings.file_format, settings.color_mode, settings.quality = "JPEG", "RGB", 90
        scene.view_settings.view_transform = "Standard"
        bpy.data.images.load(str(job / "window.png")).save_render(str(chosen.image), scene=scene)


def run(job: Path, *arguments: str) -> str:
    """What Blender prints, in a window or without one."""
    return subprocess.run(
        [BLENDER_WINDOW, "run", job, *arguments], capture_output=True, text=True, check=True
    ).stdout


if __name__ == "__main__":
    main()

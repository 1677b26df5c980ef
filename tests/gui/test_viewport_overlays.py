"""What Blender draws over surfaces in its window stays in sight over previews."""

from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.flat_capture import write_flat_capture
from rsibr.tests.gui.test_viewport_pixels import PRELUDE, PURPLE

OVERLAYS = """
def scenario(told):
    cube, overlay = red_cube(), view().spaces.active.overlay
    yield from drawn()
    surface = like(pixels(), (255, 0, 0))
    overlay.show_cursor = overlay.show_outline_selected = overlay.show_object_origins = True
    yield from drawn()
    marks = surface & ~like(pixels(), (255, 0, 0))
    # Dashes of the cursor, and pixels that the outline takes of the surface
    told["marks"] = int(marks.sum())
    cube.rsibr.map_set = "/job/flat.rsibr.exr"
    yield from drawn()
    told["otherwise"] = int((like(pixels(), (188, 0, 188)) != (surface & ~marks)).sum())
    # A line between two looks is a mark of ours, and lies over all
    bpy.context.window_manager.rsibr_view.split = True
    yield from drawn()
    white = np.all(pixels() == 255, axis=-1)
    told["line"] = np.flatnonzero(white.mean(axis=0) > 0.9).tolist()
    told["middle"] = white.shape[1] // 2
"""


@pytest.fixture(autouse=True)
def _flat(job: Path) -> None:
    write_flat_capture(job / "flat.rsibr.exr", PURPLE)


def test_marks_of_blender_lie_over_previews(told: Callable[[str], dict]) -> None:
    answer = told(PRELUDE + OVERLAYS)
    marks = answer.pop("marks")
    assert marks > 300
    # Marks blend with what is beneath them: some of their edges may be as purple as what they mark
    assert answer.pop("otherwise") <= 0.05 * marks
    assert answer["line"] == [answer["middle"] - 1, answer["middle"]]

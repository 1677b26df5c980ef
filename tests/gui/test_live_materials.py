"""Materials edited in Blender's window: shaded at once from one kernel bank, without a bake."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.lobes.bake import bake_bank
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.kinds.kernel_bank import to_map_set
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.map_set_header import Origin

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _bank(job: Path) -> None:
    light = np.full((64, 128, 3), 0.2, dtype=np.float32)
    light[40:50, 20:40] = 6.0
    baked = drain(bake_bank(light, "dual_paraboloid", 64))
    map_set = to_map_set(baked, Origin(Environment(light, "a lamp"), {}, "a test"))
    write_map_set(job / "bank.rsibr.exr", map_set, force=True)


WORKERS = ["rsibr worker", "rsibr-map-sets_0"]
"""Threads of ours, once a kernel bank is previewed."""

PRELUDE = """
import threading
map_sets = importlib.import_module(ROOT + ".rsibr_addon.tasks.viewport.map_sets")

def workers():
    return sorted(thread.name for thread in threading.enumerate() if thread.name.startswith("rsibr"))

def in_bank(item):
    item.rsibr.map_set = "/job/bank.rsibr.exr"
    return item.rsibr.kernel_bank

def previewed_cube():
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    return in_bank(bpy.data.objects["Cube"])

def left_and_right(picture):
    # Means of the halves
    shown = picture.mean(axis=2)
    shown = np.where(shown > 70, shown, 0)
    middle = shown.shape[1] // 2
    return [float(half.sum()) for half in (shown[:, :middle], shown[:, middle:])]
"""

EDIT = """
def scenario(told):
    material = previewed_cube()
    material.brdf, material.lobe_count = "lambert:kd=0.8", 2
    yield from drawn()
    told["workers"] = workers()
    before = pixels()
    bank = session().previews._map_sets.used["/job/bank.rsibr.exr"].gpu_map_set
    map_sets.open_map_set = lambda path: 1 / 0  # Nothing is read or uploaded anew
    material.brdf = "ggx:alpha=0.15,metal=copper"
    seen = [before]
    while len(seen) == 1 or previews_wait():
        # Whatever is drawn, the cube is shown: as before, as a draft, as it is to be
        view().tag_redraw()
        yield
        now = pixels()
        if not np.array_equal(now, seen[-1]):
            seen.append(now)
    yield from drawn()
    told["covered"] = [int((picture.max(axis=2) > 70).sum()) for picture in seen]
    told["changed"] = int((np.abs(pixels() - before).max(axis=2) > 10).sum())
    copper = pixels()
    material.use_roughness, material.roughness = True, 0.9
    yield from drawn()
    told["roughened"] = int((np.abs(pixels() - copper).max(axis=2) > 10).sum())
    material.use_roughness = False
    yield from drawn()
    told["back"] = int(np.abs(pixels() - copper).max())
    told["same bank"] = session().previews._map_sets.used["/job/bank.rsibr.exr"].gpu_map_set is bank
    told["trouble"] = session().previews.faults.trouble
"""


def test_a_material_is_edited_without_a_bake(told: Told) -> None:
    answer = told(PRELUDE + EDIT)
    assert answer["workers"] == WORKERS
    assert min(answer["covered"]) > 5000
    assert answer["changed"] > 2000
    assert answer["roughened"] > 2000
    assert answer["back"] <= 1
    assert answer["same bank"]
    assert answer["trouble"] is None


DRAG = """
def scenario(told):
    material = previewed_cube()
    material.brdf, material.use_roughness, material.lobe_count = "ggx:alpha=0.3,metal=gold", True, 2
    yield from drawn()
    seen = [pixels()]
    while len(seen) < 4:
        # A new value at each step, up and up again: what is shown follows, if it is always a little late
        material.roughness = 0.3 + (material.roughness - 0.298) % 0.6
        yield
        now = pixels()
        if not np.array_equal(now, seen[-1]):
            seen.append(now)
    told["pictures"] = len(seen)
    yield from drawn()
    told["trouble"] = session().previews.faults.trouble
    asked = next(iter(session().previews._looks.asked.values()))
    told["asked"] = [[round(look.roughness, 4), look.lobe_count] for look in asked]
    told["value"] = round(material.roughness, 4)
"""


def test_a_slider_shows_on_its_way(told: Told) -> None:
    answer = told(PRELUDE + DRAG)
    assert answer["pictures"] == 4
    assert answer["asked"] == [[answer["value"], 2]]
    assert answer["trouble"] is None


TWO = """
def scenario(told):
    material = previewed_cube()
    cube = bpy.data.objects["Cube"]
    other = bpy.data.objects.new("Other", cube.data)
    bpy.context.collection.objects.link(other)
    cube.location, other.location = (-1.5, 0.0, 0.0), (1.5, 0.0, 0.0)
    part = view().spaces.active.region_3d
    part.view_rotation, part.view_distance = (0.7071, 0.7071, 0.0, 0.0), 12.0
    part.view_perspective = "ORTHO"  # else each shows another of its sides
    in_bank(other).brdf = "lambert:kd=0.9"
    material.brdf = "lambert:kd=0.5"
    yield from drawn()
    told["dark and bright"] = left_and_right(pixels())
    material.brdf, other.rsibr.kernel_bank.brdf = "lambert:kd=0.9", "lambert:kd=0.5"
    yield from drawn()
    told["bright and dark"] = left_and_right(pixels())
    material.brdf = "gold"
    yield from drawn()
    told["faults"] = [session().previews.faults.message(item) for item in (cube, other)]
    material.brdf = "lambert:kd=0.5"
    yield from drawn()
    told["after"] = session().previews.faults.message(cube)
    told["both dark"] = left_and_right(pixels())
"""


def test_objects_share_a_bank_and_have_materials_of_their_own(told: Told) -> None:
    answer = told(PRELUDE + TWO)
    left, right = answer["dark and bright"]
    assert right > 1.2 * left > 0
    assert answer["bright and dark"] == pytest.approx([right, left], rel=0.05)
    assert 'There is no BRDF model "gold"' in answer["faults"][0]
    assert answer["faults"][1] is None
    assert answer["after"] is None
    assert answer["both dark"] == pytest.approx([left, left], rel=0.05)


DISABLE = """
import addon_utils

def scenario(told):
    material = previewed_cube()
    yield from drawn()
    before = pixels()
    material.brdf = "ward:alpha=0.3,ks=0.7"
    for _ in range(4):
        view().tag_redraw()
        yield
    told["busy"] = workers()
    addon_utils.disable(ROOT)
    told["disabled"] = workers()
    addon_utils.enable(ROOT)
    yield from drawn()
    told["enabled"], told["changed"] = workers(), int(np.abs(pixels() - before).max())
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.read_homefile(use_factory_startup=True)
    yield from drawn()
    told["another file"] = workers()
"""


def test_disabling_ends_the_thread(told: Told) -> None:
    answer = told(PRELUDE + DISABLE)
    assert answer["busy"] == answer["enabled"] == answer["another file"] == WORKERS
    assert answer["disabled"] == []
    assert answer["changed"] > 10

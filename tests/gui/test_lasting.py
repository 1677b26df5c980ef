"""A preview outlasts Blender: saved, opened, appended and linked by others of its kind, to the pixel."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

Told = Callable[[str], dict]


@pytest.fixture(autouse=True)
def _nothing_saved(job: Path) -> None:
    shutil.rmtree(job / "lasting", ignore_errors=True)
    for folder in ("rsibr", "elsewhere"):
        (job / "lasting" / folder).mkdir(parents=True)


PRELUDE = """
import os
FIRST = "/job/lasting/first.npy"

def looked_at():
    # The same view of every file, whatever its own, once Blender has it in its window
    yield from drawn()
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    yield from drawn()

def save(path):
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.save_as_mainfile(filepath=path)

def as_at_first():
    now, first = pixels(), np.load(FIRST)
    return now.shape == first.shape and int((now != first).sum()) == 0
"""

SAVE = """
def scenario(told):
    yield from looked_at()
    cube, before = bpy.data.objects["Cube"], pixels()
    save("/job/lasting/car.blend")
    with bpy.context.temp_override(window=window()):
        bpy.ops.rsibr.bake_mip_chain(filepath="//rsibr/light.rsibr.exr", environment="forest", size=64)
        bpy.ops.rsibr.assign(filepath="/job/lasting/rsibr/light.rsibr.exr")
        bpy.ops.ed.undo_push(message="assigned")
    told["stored"] = cube.rsibr.map_set
    yield from drawn()
    first = pixels()
    np.save(FIRST, first)
    told["shown"] = int((abs(first - before).max(axis=-1) > 3).sum())
    save("/job/lasting/car.blend")
    with bpy.context.temp_override(window=window()):
        bpy.ops.rsibr.pack()
        bpy.ops.ed.undo_push(message="packed")
        yield from drawn()
        told["packed"] = [cube.rsibr.image.packed_file is not None, as_at_first()]
        told["shaded as"] = session().previews.kind(cube)
        bpy.ops.ed.undo()
        yield from drawn()
        told["undone"] = [bpy.data.objects["Cube"].rsibr.image.packed_file is None, as_at_first()]
        bpy.ops.ed.redo()
        yield from drawn()
        told["redone"] = [bpy.data.objects["Cube"].rsibr.image.packed_file is not None, as_at_first()]
    save("/job/lasting/packed.blend")
"""

OPEN = """
def scenario(told):
    yield
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.open_mainfile(filepath="/job/lasting/car.blend")
    yield from looked_at()
    told["opened"] = as_at_first()
    cube = bpy.data.objects["Cube"]
    told["overridable"] = cube.rsibr.bl_rna.properties["show"].is_overridable
    copy = cube.copy()
    bpy.data.objects.remove(cube)
    bpy.context.collection.objects.link(copy)
    yield from looked_at()
    told["copied"] = as_at_first()
    for source in ("car", "packed"):
        if source == "packed":
            os.rename("/job/lasting/rsibr", "/job/lasting/gone")
        for link in (False, True):
            with bpy.context.temp_override(window=window()):
                bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            save("/job/lasting/elsewhere/scene.blend")
            library = f"/job/lasting/{source}.blend"
            with bpy.data.libraries.load(library, link=link, relative=True) as (_, wanted):
                wanted.objects = ["Cube"]
            bpy.context.scene.collection.objects.link(wanted.objects[0])
            yield from looked_at()
            told[f"{source}, {'linked' if link else 'appended'}"] = as_at_first()
    # A library that is gone takes its objects with it, and is told of by Blender itself
    save("/job/lasting/elsewhere/scene.blend")
    os.remove("/job/lasting/packed.blend")
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.open_mainfile(filepath="/job/lasting/elsewhere/scene.blend")
    yield from looked_at()
    told["missing library"] = [len(pixels()) > 0, session().previews.faults.trouble]
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    order = importlib.import_module(ROOT + ".rsibr_addon.tasks.queue.bake_request")
    try:
        order.request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)
    except order.SceneError as error:
        told["sentence"] = str(error)
"""

AGAIN = """
orders = importlib.import_module(ROOT + ".rsibr_addon.tasks.queue.bake_request")

def scenario(told):
    yield from looked_at()
    cube, scene = bpy.data.objects["Cube"], bpy.context.scene
    save("/job/lasting/car.blend")
    chosen = scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "mip_chain", "STUDIO", "forest"
    chosen.mip_chain.size, chosen.mip_chain.filter = "64", "box"
    path = orders.output_for(orders.request_for(scene.rsibr_bake, scene, cube), scene, cube)
    bpy.ops.rsibr.bake_mip_chain(filepath=str(path), environment="forest", size=64, filter="box")
    bpy.ops.rsibr.bake()
    told["taken"] = bpy.path.abspath(cube.rsibr.map_set) == str(path)
    yield from drawn()
    np.save(FIRST, pixels())
    path.unlink()
    chosen.light, chosen.mip_chain.size = "WORLD", "128"
    bpy.ops.rsibr.reload_map_sets()
    yield from drawn()
    fault = f"{path} does not exist: check the name and the folder."
    told["missing"] = [as_at_first(), session().previews.faults.message(cube) == fault]
    bpy.ops.rsibr.bake_again()
    told["baking"] = session().bakes.busy
    while session().bakes.busy:
        yield
    yield from drawn()
    told["again"] = [as_at_first(), session().previews.faults.message(cube), path.is_file()]
    path.rename("/job/lasting/elsewhere/" + path.name)
    bpy.ops.rsibr.reload_map_sets()
    yield from drawn()
    told["moved"] = as_at_first()
    bpy.ops.file.find_missing_files(directory="/job/lasting")
    bpy.ops.rsibr.reload_map_sets()
    yield from drawn()
    told["found"] = as_at_first()
"""


def test_a_map_set_that_is_gone_is_baked_again(told: Told) -> None:
    assert told(PRELUDE + AGAIN) == {
        "taken": True,
        "missing": [False, True],
        "baking": True,
        "again": [True, None, True],
        "moved": False,
        "found": True,
    }


def test_a_preview_is_the_same_in_every_file_that_has_the_object(told: Told) -> None:
    saved = told(PRELUDE + SAVE)
    assert saved.pop("shown") > 3000
    assert saved == {
        "stored": "//rsibr/light.rsibr.exr",
        "packed": [True, True],
        "shaded as": "mip_chain",
        "undone": [True, True],
        "redone": [True, True],
    }
    opened = told(PRELUDE + OPEN)
    assert opened.pop("sentence").startswith("Object Cube is missing in //../packed.blend: bring")
    assert opened == {
        "opened": True,
        "overridable": True,
        "copied": True,
        "car, appended": True,
        "car, linked": True,
        "packed, appended": True,
        "packed, linked": True,
        "missing library": [True, None],
    }

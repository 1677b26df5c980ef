"""A bake of the scene that was written for a background Blender is the bake of the open file."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.light import environments
from rsibr.rsibr_addon.tasks.queue.bake_request import bake_of, request_for
from rsibr.tests.bake_jobs import run_job

pytestmark = pytest.mark.usefixtures("quick_furnace")

HEIGHT = 16
"""Of the environment that the world is sampled into, here and in the other process."""

CHILD = f"""
import sys
import bpy
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.host import furnace
from rsibr.rsibr_addon.tasks.light import environments
environments.WORLD_HEIGHT, furnace.SAMPLES = {HEIGHT}, 4
words = sys.argv[1:]
bpy.ops.wm.open_mainfile(filepath=words[2], use_scripts=False)
bpy.context.window.scene = bpy.data.scenes[words[words.index("--scene") + 1]]
sys.exit(run(words[words.index("--command") + 2:]))
"""
"""Does with a bake's command line what Blender's program does with it."""


@pytest.fixture(autouse=True)
def _registered(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.queue.bake_request.blender_program", lambda: "blender")
    monkeypatch.setattr(environments, "WORLD_HEIGHT", HEIGHT)
    rsibr.register()
    yield
    rsibr.unregister()


def noise(seed: int, *shape: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0.1, 1.0, shape).astype(np.float32)


def pictures(folder: Path) -> None:
    picture = bpy.data.images.new("Rust", 8, 8)
    picture.pixels.foreach_set(noise(1, 8 * 8 * 4))
    picture.filepath_raw, picture.file_format = str(folder / "rust.png"), "PNG"
    picture.save()
    bpy.data.images.remove(picture)
    write_radiance(folder / "sky.exr", noise(2, 16, 32, 3))


def show(folder: str) -> None:
    """Take the material's colour and the world from the pictures in a folder, as Blender writes it."""
    tree = bpy.context.object.active_material.node_tree
    texture, place = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeTexCoord")
    texture.image = bpy.data.images.load(folder + "rust.png")
    tree.links.new(place.outputs["Reflection"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    light_from(bpy.context.scene.world, folder + "sky.exr")


def textured(folder: Path) -> None:
    """A file with the default scene, its pictures beside it; it has not been saved since it uses them."""
    pictures(folder)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "open.blend"))
    show("//")


def light_from(world: bpy.types.World, path: str) -> None:
    tree = world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(path)
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def saved(folder: Path) -> None:
    textured(folder)
    bpy.ops.wm.save_mainfile()


def changed_since(folder: Path) -> None:
    saved(folder)
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 3.0


def never_saved(folder: Path) -> None:
    pictures(folder)
    show(f"{folder}{os.sep}")


def packed(folder: Path) -> None:
    textured(folder)
    for name in ("rust.png", "sky.exr"):
        bpy.data.images[name].pack()
        (folder / name).unlink()


def linked(folder: Path) -> None:
    """Material and world from a library in another folder, whose pictures are beside it."""
    (folder / "library").mkdir()
    textured(folder / "library")
    bpy.context.object.active_material.name, bpy.context.scene.world.name = "Theirs", "Their sky"
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "open.blend"))
    library = str(folder / "library" / "open.blend")
    with bpy.data.libraries.load(library, link=True, relative=True) as (_, wanted):
        wanted.materials, wanted.worlds = ["Theirs"], ["Their sky"]
    bpy.context.object.active_material, bpy.context.scene.world = wanted.materials[0], wanted.worlds[0]


def modified(folder: Path) -> None:
    textured(folder)
    for kind in ("SUBSURF", "BEVEL", "PARTICLE_SYSTEM"):
        bpy.context.object.modifiers.new(kind, kind)


def second_scene(folder: Path) -> None:
    """The artist works in the scene that is not the first by the alphabet; its world is another."""
    textured(folder)
    cube, other = bpy.context.object, bpy.data.scenes.new('Zoë\'s "scene"')
    other.world = bpy.data.worlds.new("Its own")
    write_radiance(folder / "other.exr", 5.0 * noise(3, 16, 32, 3))
    light_from(other.world, "//other.exr")
    other.collection.objects.link(cube)
    bpy.context.window.scene = other
    bpy.context.view_layer.objects.active = cube


def animated(folder: Path) -> None:
    """The world's strength follows an object that is in no scene."""
    textured(folder)
    guide = bpy.data.objects.new("Guide", None)
    guide.location.x = 4.0
    driver = (
        bpy.context.scene.world.node_tree.nodes["Background"].inputs["Strength"].driver_add("default_value")
    )
    variable = driver.driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = guide, "location.x"
    driver.driver.expression = variable.name
    bpy.context.scene.frame_set(20)


@pytest.mark.slow
@pytest.mark.parametrize(
    "make", [changed_since, never_saved, packed, linked, modified, second_scene, animated]
)
def test_the_written_scene_gives_the_same_bake(make: Callable[[Path], None], tmp_path: Path) -> None:
    make(tmp_path)
    chosen, item, scene = bpy.context.scene.rsibr_bake, bpy.context.object, bpy.context.scene
    chosen.kind, views = "radiance_views", chosen.radiance_views
    views.size, views.samples, views.denoise = 8, 4, False
    request = request_for(scene.rsibr_bake, scene, item)
    theirs, ours = tmp_path / "theirs.rsibr.exr", tmp_path / "ours.rsibr.exr"
    bake = bake_of(request, scene, [item], theirs)
    child = subprocess.run(
        [sys.executable, "-c", CHILD, *bake.command[1:]],
        env={**os.environ, **bake.variables},
        capture_output=True,
        text=True,
        check=False,
    )
    bake.tidy()
    assert child.returncode == 0, child.stdout + child.stderr
    assert run_job(request.job(ours), tmp_path) == 0
    assert theirs.read_bytes() == ours.read_bytes()


def test_what_only_this_blender_holds_is_told_before_a_bake(tmp_path: Path) -> None:
    textured(tmp_path)
    bpy.context.scene.rsibr_bake.kind = "radiance_views"
    request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)
    painted = bpy.data.images["rust.png"]
    painted.pixels.foreach_set(noise(4, 8 * 8 * 4))
    painted.update()
    with pytest.raises(SceneError, match=r"Image rust\.png has pixels that are not saved.*: save or pack it"):
        request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)
    assert not bpy.ops.rsibr.bake.poll()
    painted.pack()
    request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)
    sky = bpy.data.images["sky.exr"]
    sky.pixels.foreach_set(noise(5, 16 * 32 * 4))
    sky.update()
    with pytest.raises(SceneError, match=r"Image sky\.exr has pixels"):
        request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)

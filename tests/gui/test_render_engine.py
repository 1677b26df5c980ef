"""The render engine in a Blender of its own: F12, while the window goes on; an animation without a window."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.files.pictures import read_exr

Told = Callable[..., dict]

PRELUDE = """
RENDER = importlib.import_module(ROOT + ".rsibr_addon.ui.render_engine")

def scene_in_the_world():
    bpy.ops.wm.save_as_mainfile(filepath="/job/render.blend")
    scene = bpy.context.scene
    scene.render.engine, scene.view_settings.view_transform = "RSIBR", "Standard"
    scene.rsibr_bake.kernel_pyramid.size, scene.rsibr_render.samples = "256", 1
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.8, 1.0)
    scene.render.dither_intensity = 0.0
    scene.render.image_settings.media_type = "IMAGE"
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "PNG", "8"
    scene.render.filepath = "/job/render.png"
    material = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"].inputs
    material["Base Color"].default_value = (0.9, 0.5, 0.1, 1.0)
    return scene

def rendered(path="/job/render.png"):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    found = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(found)
    bpy.data.images.remove(image)
    return np.rint(255.0 * found).astype(int).reshape(height, width, 4)[..., :3]

def f12(window_shown="NONE"):
    # As the key does: in a thread of its own, while the window goes on
    bpy.context.preferences.view.render_display_type = window_shown
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        assert bpy.ops.render.render("INVOKE_DEFAULT", write_still=True) == {"RUNNING_MODAL"}
    while not bpy.app.is_job_running("RENDER"):
        yield
    while bpy.app.is_job_running("RENDER"):
        yield
    yield
"""

NOT_BAKED = """
def scenario(told):
    scene_in_the_world()
    bpy.context.scene.render.resolution_percentage = 20
    yield from f12()
    told["world"] = rendered()[2, 2].tolist()
    told["baked"] = len(list(Path("/job/rsibr").glob("*.rsibr.exr")))
    told["held"] = len(session().renders._previews._map_sets.used)
"""


def test_f12_bakes_the_world_that_was_not_baked(told: Told) -> None:
    answer = told(PRELUDE + NOT_BAKED)
    assert answer["baked"] >= 1
    assert answer["world"] == [124, 170, 231]
    assert answer["held"] == 0


RENDERED = """
def scenario(told):
    # A viewport that the camera's frame fills: Blender draws it ((sqrt(2) + zoom / 50) / 2)^2 times as large
    scene, part = scene_in_the_world(), region(view())
    bpy.ops.mesh.primitive_monkey_add(location=(0.0, -2.5, 0.5))
    bpy.ops.mesh.primitive_plane_add(size=6.0, location=(0.0, 0.0, -1.0))
    bpy.context.object.is_shadow_catcher = True
    # A card before the cube, all of which is a hole
    camera = scene.camera
    bpy.ops.mesh.primitive_plane_add(location=0.5 * camera.location, rotation=camera.rotation_euler)
    hole = bpy.data.materials.new("Hole")
    hole.node_tree.nodes["Principled BSDF"].inputs["Alpha"].default_value = 0.0
    bpy.context.object.data.materials.append(hole)
    scene.render.resolution_x, scene.render.resolution_y = part.width, part.height
    bare(view())
    space = view().spaces.active
    space.region_3d.view_perspective = "CAMERA"
    space.region_3d.view_camera_zoom = 50.0 * (2.0 - math.sqrt(2.0))
    scene.camera.data.passepartout_alpha = 0.0
    yield from f12()
    space.shading.type = "RENDERED"
    yield from drawn()
    world = rendered()[2, 2]
    while not like(pixels(), world).any():  # the world's bake has come
        yield from drawn()
    shown, picture = pixels(), rendered()
    is_surface = picture[..., 0] > picture[..., 2]
    told["shows surfaces"] = float(is_surface.mean())
    told["shows shadow"] = float((~is_surface & (picture[..., 2] < 0.9 * world[2])).mean())
    told["alike"] = float((np.abs(shown - picture).max(axis=-1) <= 4).mean())
"""


def test_rendered_shows_what_f12_renders(told: Told) -> None:
    answer = told(PRELUDE + RENDERED)
    assert 0.05 < answer["shows surfaces"] < 0.5  # in orange, in a blue world
    assert 0.01 < answer["shows shadow"] < 0.5
    # But for edges; 3 are Mesa's, see in_window.like, and 1 is of rounding
    assert answer["alike"] > 0.98


STOPPED = """
def scenario(told):
    scene = scene_in_the_world()
    scene.render.resolution_percentage = 20
    yield from f12()
    drawn_by_render = []
    picture = RENDER.Picture
    add_sample = picture.add_sample

    def counted(self):
        drawn_by_render.append(threading.current_thread() is not threading.main_thread())
        add_sample(self)

    picture.add_sample = counted
    scene.rsibr_render.samples = 1000
    steps = f12()
    while len(drawn_by_render) < 3:
        next(steps)
        yield
    xshot.press(xshot.ESCAPE)
    yield from steps
    told["samples"] = len(drawn_by_render)
    told["aside"] = all(drawn_by_render)
    told["held"] = len(session().renders._previews._map_sets.used)
    Path("/job/render.png").unlink()
    scene.rsibr_render.samples = 1
    yield from f12()
    told["world"] = rendered()[2, 2].tolist()
    bare(view())
    view().spaces.active.shading.type = "RENDERED"
    yield from drawn()
    while not like(pixels(), (124, 170, 231)).any():
        yield from drawn()
"""


def test_esc_ends_a_render_and_the_next_one_works(told: Told) -> None:
    """In the viewport, too, the world is drawn again."""
    answer = told("import threading\n" + PRELUDE + STOPPED, by_keyboard=True)
    assert 3 <= answer["samples"] < 1000
    assert answer["aside"]
    assert answer["held"] == 0
    assert answer["world"] == [124, 170, 231]


FILE = """
import bpy
scene = bpy.context.scene
scene.rsibr_bake.kernel_pyramid.size, scene.rsibr_render.samples = "256", 1
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.4, 0.8, 1.0)
scene.render.resolution_percentage = 5
cube = bpy.data.objects["Cube"]
cube.keyframe_insert("location", frame=1)
cube.location.x = 100.0
cube.keyframe_insert("location", frame=2)
bpy.ops.wm.save_as_mainfile(filepath="/job/animated.blend")
"""


def test_an_animation_without_a_window(
    blender: Callable[..., subprocess.CompletedProcess[str]], job: Path
) -> None:
    assert blender("-b", "--python-expr", FILE).returncode == 0
    frames = "-F", "OPEN_EXR", "-o", "/job/frame#", "-s", "1", "-e", "2", "-a"
    rendered = blender("-b", "/job/animated.blend", "-E", "RSIBR", *frames)
    assert rendered.returncode == 0, rendered.stderr
    first, second = (read_exr(job / f"frame{number}.exr")[..., :3] for number in (1, 2))
    blue = np.isclose(second, (0.2, 0.4, 0.8), rtol=1e-3)  # half floats
    assert blue.all(), "the cube has left the picture"
    assert 0.05 < np.mean(first != second) < 0.5

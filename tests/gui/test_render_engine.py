"""The render engine in Blender's window: F12 while it goes on, and Rendered in a viewport."""

from collections.abc import Callable

Told = Callable[[str], dict]

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

F12 = """
def scenario(told):
    scene = scene_in_the_world()
    shown = view().spaces.active
    shown.region_3d.view_perspective = "CAMERA"
    shown.shading.type = "RENDERED"
    shown.show_gizmo = shown.show_region_header = shown.show_region_toolbar = False
    shown.overlay.show_overlays = False
    while session().previews._map_sets.used.keys() <= {""} or session().bakes.busy:
        yield from drawn()
    yield from drawn()
    part, zoom = region(view()), shown.region_3d.view_camera_zoom
    seen = pixels()
    # The frame fills the region's width: a render of the region's own view
    matrix, projection = shown.region_3d.view_matrix.copy(), shown.region_3d.window_matrix.copy()
    told["world in the corner"] = seen[2, 2].tolist()
    told["colours in the viewport"] = len(np.unique(seen.reshape(-1, 3), axis=0))
    scene.render.resolution_x, scene.render.resolution_y = part.width, part.height
    scene.render.resolution_percentage = 100
    # A camera that sees what the viewport shows through the other one, with its margins
    camera = scene.camera.data
    camera.sensor_fit = "HORIZONTAL"
    camera.sensor_width *= (1.0 / projection[0][0]) / (camera.sensor_width / 2.0 / camera.lens)
    yield from f12()
    picture = rendered()
    told["size"] = [list(picture.shape), list(seen.shape)]
    apart = np.abs(picture - seen).max(axis=-1)
    told["apart"] = [int((apart > 1).sum()), int(apart.max())]
    told["covered"] = int((picture != picture[2, 2]).any(axis=-1).sum())
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


def test_a_frame_by_f12_is_what_rendered_shows(told: Told) -> None:
    answer = told(PRELUDE + F12)
    first, second = answer["size"]
    assert first == second
    assert answer["covered"] > 5000
    assert answer["colours in the viewport"] > 3
    print(answer)


def test_f12_bakes_the_world_that_was_not_baked(told: Told) -> None:
    answer = told(PRELUDE + NOT_BAKED)
    assert answer["baked"] == 1
    print(answer)

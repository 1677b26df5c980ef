"""Live light in Blender's window: objects mirror what surrounds them, and follow it."""

from collections.abc import Callable

Told = Callable[[str], dict]

PRELUDE = """
from bpy_extras.view3d_utils import location_3d_to_region_2d
previews = session().previews

SIDES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]

def room(colours):
    # Six walls about the origin, seen from within alone
    corners = [(-3, -3, -3), (3, -3, -3), (3, 3, -3), (-3, 3, -3)]
    walls = []
    for side, colour in zip(SIDES, colours):
        mesh = bpy.data.meshes.new("Wall")
        mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
        wall = bpy.data.objects.new("Wall", mesh)
        bpy.context.collection.objects.link(wall)
        wall.matrix_world = Vector((0, 0, -1)).rotation_difference(Vector(side)).to_matrix().to_4x4()
        wall.color = (*colour, 1.0)
        walls.append(wall)
    return walls

def mirror():
    bare(view())
    space = view().spaces.active
    space.shading.show_backface_culling = True
    bpy.context.scene.view_settings.view_transform = "Standard"
    cube = bpy.data.objects["Cube"]
    cube.color = (1.0, 0.0, 0.0, 1.0)
    cube.rsibr.mip_chain.f_lambda, cube.rsibr.mip_chain.k_d = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
    live = cube.rsibr.live
    live.size, live.budget, live.mips = "32", 1000, True
    return cube

def only_light():
    (light,) = previews._map_sets.lights.values()
    return light

def own():
    # Blender's own pixels of the cube, red
    return like(pixels(), (255, 0, 0))

def others(colour, among):
    return int((among & ~like(pixels(), colour)).sum())
"""

FOLLOWS = """
def scenario(told):
    cube = mirror()
    view().spaces.active.overlay.show_object_origins_all = True
    bpy.context.view_layer.objects.active = None
    walls = room([(0.5, 0.2, 0.5)] * 6)
    yield from drawn()
    among = own()
    told["own"] = int(among.sum())
    cube.rsibr.live.on = True
    yield from drawn()
    told["mirror"] = others((188, 124, 188), among)
    cube.rsibr.mip_chain.f_lambda, cube.rsibr.mip_chain.k_d = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    yield from drawn()
    told["white"] = others((188, 124, 188), among)
    for wall in walls:
        wall.color = (0.2, 0.5, 0.2, 1.0)
    yield from drawn()
    told["changed"] = others((124, 188, 124), among)
    cube.location = (0.5, 0.5, 0.5)
    yield from drawn()
    told["moved"] = [others((124, 188, 124), among), int(own().sum())]
    told["overlays"] = view().spaces.active.overlay.show_overlays
    updates, draws = [], []
    bpy.app.handlers.depsgraph_update_post.append(lambda *_: updates.append(0))
    bpy.types.SpaceView3D.draw_handler_add(lambda: draws.append(0), (), "WINDOW", "POST_PIXEL")
    for _ in range(25):
        yield
    told["idle"] = [len(updates), len(draws)]
    told["faults"] = [previews.faults.message(cube), previews.faults.trouble, previews.kind(cube)]
    cube.rsibr.mip_chain.bias, cube.rsibr.mip_chain.use_roughness = 2.0, True
    yield from drawn()
    told["roughness"] = [others((124, 188, 124), among), previews.faults.message(cube)]
    plate = bpy.data.meshes.new("Plate")
    corners = (0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)
    plate.from_pydata([(x, y, 0.5) for x, y in corners], [], [(3, 2, 1, 0)])
    plate = bpy.data.objects.new("Plate", plate)
    plate.color = (0.0, 0.0, 1.0, 1.0)
    bpy.context.collection.objects.link(plate)
    cube.location = (0.5, 0.5, 0.1)
    cube.select_set(True)
    yield from drawn()
    size = only_light().gpu_map_set.size
    strip = np.array(only_light().gpu_map_set._faces.texture.read()).reshape(size, 6, size, 4)
    told["within"] = strip[size // 2, :, size // 2, :3].astype(float).round(2).tolist()
    told["kept"] = [cube.select_get(), cube.hide_get(), previews.is_hiding]
    cube.rsibr.live.on = False
    yield from drawn()
    map_sets = previews._map_sets
    told["off"] = [int(own().sum()), len(map_sets.lights), len(map_sets.used), previews.faults.message(cube)]
"""


def test_an_object_shows_its_surroundings_and_follows_them(told: Told) -> None:
    answer = told(PRELUDE + FOLLOWS)
    assert answer["own"] > 2000
    assert answer["mirror"] == answer["white"] == answer["changed"] == 0
    assert answer["moved"] == [0, 0]
    assert answer["overlays"] is True
    assert answer["idle"] == [0, 0]
    assert answer["faults"] == [None, None, "mip_chain"]
    assert answer["roughness"] == [0, None]
    # Above the middle, within the cube
    assert answer["within"] == [[0.2, 0.5, 0.2]] * 4 + [[0.0, 0.0, 1.0], [0.2, 0.5, 0.2]]
    assert answer["kept"] == [True, False, False]
    assert answer["off"][0] > 2000
    assert answer["off"][1:] == [0, 0, None]


MIRRORED = """
def scenario(told):
    cube = mirror()
    colours = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1)]
    room(colours)
    cube.rsibr.live.on = True
    region_3d = view().spaces.active.region_3d
    region_3d.view_perspective = "ORTHO"
    told["errors"] = []
    for towards in ((0.5, -0.6, 0.62), (0.8, -0.35, 0.48), (-0.3, 0.9, -0.25), (-0.7, -0.5, 0.5)):
        view_dir = Vector(towards).normalized()
        region_3d.view_rotation = view_dir.to_track_quat("Z", "Y")
        yield from drawn()
        picture = pixels()
        for side in map(Vector, SIDES):
            if side.dot(view_dir) > 0.0:
                mirrored = view_dir.reflect(side) * -1.0
                axis = max(range(3), key=lambda i: abs(mirrored[i]))
                wall = colours[2 * axis + (mirrored[axis] < 0.0)]
                x, y = location_3d_to_region_2d(region(view()), region_3d, side)
                seen = picture[int(y), int(x)]
                if not like(seen, tuple(255 * c for c in wall)):
                    told["errors"].append([towards, list(side), wall, seen.tolist()])
"""


def test_each_side_mirrors_the_wall_that_it_faces(told: Told) -> None:
    assert told(PRELUDE + MIRRORED)["errors"] == []


BUDGET = """
import types
live_light = importlib.import_module(ROOT + ".rsibr_addon.tasks.viewport.live_light")

def scenario(told):
    cube = mirror()
    walls = room([(0.5, 0.2, 0.5)] * 6)
    # A face takes two milliseconds, by a clock of our own
    def see(*arguments):
        clock.now += 2e-3
        return seen(*arguments)

    clock = types.SimpleNamespace(now=0.0, perf_counter=lambda: clock.now)
    live_light.time, seen = clock, live_light.ViewportCamera.see
    live_light.ViewportCamera.see = see
    cube.rsibr.live.budget = 1
    cube.rsibr.live.on = True
    yield from drawn()
    told["left to Blender"] = int(own().sum())
    light = only_light()
    faces, updates = [], []
    set_face, filtered = light.gpu_map_set.set_face, light.gpu_map_set.filter
    light.gpu_map_set.set_face = lambda face, seen: (faces.append(face), set_face(face, seen))
    light.gpu_map_set.filter = lambda: (updates.append(len(faces)), filtered())

    def counted():
        faces.clear()
        updates.clear()
        yield from drawn()
        return sorted(faces), updates[:]

    walls[0].color = (0.2, 0.5, 0.2, 1.0)
    told["half a face"] = yield from counted()
    cube.rsibr.live.budget = 20
    walls[0].color = (0.5, 0.2, 0.5, 1.0)
    told["ten faces"] = yield from counted()
    told["kept"] = only_light() is light
    cube.rsibr.live.size = "64"
    yield from drawn()
    told["another size"] = only_light().gpu_map_set.size
    view().spaces.active.shading.type = "WIREFRAME"
    walls[0].color = (0.5, 0.0, 0.0, 1.0)
    told["wires"] = yield from counted()
"""


def test_a_frame_renders_as_many_faces_as_its_budget_allows(told: Told) -> None:
    assert told(PRELUDE + BUDGET) == {
        "left to Blender": 0,
        "half a face": [[0, 1, 2, 3, 4, 5], [1, 2, 3, 4, 5, 6]],
        "ten faces": [[0, 1, 2, 3, 4, 5], [6]],
        "kept": True,
        "another size": 64,
        "wires": [[], []],
    }


PLAYED = """
def scenario(told):
    cube = mirror()
    walls = room([(0.0, 0.0, 0.0)] * 6)
    yield from drawn()
    among = own()
    cube.rsibr.live.on = True
    for wall in walls:
        for frame, red in ((1, 0.0), (101, 1.0)):
            wall.color = (red, 0.5, 0.2, 1.0)
            wall.keyframe_insert("color", frame=frame)
    scene = bpy.context.scene
    scene.frame_end = 101

    def errors():
        red = walls[0].color[0]
        encoded = 255 * (1.055 * red ** (1 / 2.4) - 0.055)
        return others((encoded, 188, 124), among)

    told["errors"], told["area"] = [], int(among.sum())
    for frame in (51, 26):
        scene.frame_set(frame)
        yield from drawn()
        told["errors"].append(errors())
    faces, updated_at = only_light().gpu_map_set, set()
    filtered = faces.filter
    faces.filter = lambda: (updated_at.add(scene.frame_current), filtered())
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.screen.animation_play()
    while len(updated_at) < 5:
        yield
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        bpy.ops.screen.animation_cancel(restore_frame=False)
    yield from drawn()
    told["errors"].append(errors())
"""


def test_an_animation_s_light_is_followed_while_it_plays(told: Told) -> None:
    answer = told(PRELUDE + PLAYED)
    assert answer["area"] > 2000
    assert answer["errors"] == [0, 0, 0]


LAYERS = """
def scenario(told):
    # The first window shows another view layer in another shading than the second
    mirror()
    room([(0.5, 0.2, 0.5)] * 6)
    bpy.data.objects["Cube"].rsibr.live.on = True
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.window_new_main()
    window().view_layer = bpy.context.scene.view_layers.new("Another")
    view().spaces.active.shading.light = "STUDIO"
    for _ in range(3):
        yield from drawn()
    faces, set_face = [], only_light().gpu_map_set.set_face
    only_light().gpu_map_set.set_face = lambda face, seen: (faces.append(face), set_face(face, seen))
    for _ in range(3):
        yield from drawn()
    told["at rest"], told["layers"] = faces, len(previews._layers.layers)
"""


def test_an_object_in_two_view_layers_has_one_light(told: Told) -> None:
    assert told(PRELUDE + LAYERS) == {"at rest": [], "layers": 2}

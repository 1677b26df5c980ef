"""Inputs baked by Cycles: where they lie, what they are, and that the artist's file stays as it was."""

import json
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.errors import SceneError
from rsibr.rsibr_addon.core.materials.packing import Picture, pictures_of
from rsibr.rsibr_addon.core.materials.principled import Texture
from rsibr.rsibr_addon.core.materials.sampling import sample
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.baked_inputs import BakedInputs, read_baked_inputs
from rsibr.rsibr_addon.host.meshes import evaluated_mesh
from rsibr.rsibr_addon.host.principled import principled
from rsibr.rsibr_addon.settings.baked_inputs import BakedInputsSettings
from rsibr.rsibr_addon.tasks.baked_inputs import bake_inputs
from rsibr.tests.json_command import json_result
from rsibr.tests.open_file import linked_cube, open_file_state
from rsibr.tests.written_pictures import write_png

SIZE = 64
SETTINGS = BakedInputsSettings(size=SIZE, samples=1)

BESIDE = 0.002 * 2 / 6 * 1.01
"""Blender bakes up to .002 texels beside a texel's centre; the cube's width, 2, takes at least 6 texels, over
which coordinates are linear, as lookups between texels are."""

ON_PICTURE = Texture("picture", extension="EXTEND")


class Cube:
    """The cube that Blender starts with, and its material's nodes."""

    def __init__(self) -> None:
        self.item = bpy.context.object
        self.material = self.item.active_material
        self.tree = self.material.node_tree
        self.bsdf = self.tree.nodes["Principled BSDF"]

    def add(self, kind: str, **properties: object) -> bpy.types.Node:
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in properties.items():
            setattr(node, name, value)
        return node

    def link(self, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket | str) -> None:
        self.tree.links.new(first, self.bsdf.inputs[second] if isinstance(second, str) else second)

    def coordinates(self, name: str = "Generated") -> bpy.types.NodeSocket:
        return self.add("TexCoord").outputs[name]

    def part(self, vector: bpy.types.NodeSocket, axis: str) -> bpy.types.NodeSocket:
        node = self.add("SeparateXYZ")
        self.link(vector, node.inputs[0])
        return node.outputs[axis]


@pytest.fixture
def cube() -> Iterator[Cube]:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    return Cube()


def baked(tmp_path: Path, settings: BakedInputsSettings = SETTINGS, item: str = "Cube") -> BakedInputs:
    path = tmp_path / "baked.exr"
    drain(bake_inputs(item, settings, path, force=True))
    return read_baked_inputs(path)


def in_middles(found: BakedInputs, key: tuple[int, Picture], item: bpy.types.Object) -> tuple[Array, Array]:
    """What a picture says in the middle of each triangle, and the middle in the object's coordinates."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    with evaluated_mesh(item, depsgraph) as mesh:
        corners = found.corners
        if corners is None:
            corners = np.array([each.vector[:] for each in mesh.uv_layers[found.uv_map].uv])
        places = np.array([mesh.vertices[loop.vertex_index].co[:] for loop in mesh.loops])
        mesh.calc_loop_triangles()
        triangles = np.array([each.loops[:] for each in mesh.loop_triangles])
        uv, middle = corners[triangles].mean(axis=1), places[triangles].mean(axis=1)
    texels = np.pad(found.pictures[key], ((0, 0), (0, 0), (0, 1)))
    return sample(ON_PICTURE, texels, uv)[:, :3], middle


def without_uv_map(cube: Cube) -> None:
    cube.item.data.uv_layers.remove(cube.item.data.uv_layers[0])


def overlapping(cube: Cube) -> None:
    layer = cube.item.data.uv_layers[0]
    layer.uv.foreach_set("vector", np.tile([0, 0, 1, 0, 1, 1, 0, 1], 6).astype(np.float32))


def in_another_tile(cube: Cube) -> None:
    for each in cube.item.data.uv_layers[0].uv:
        each.vector.x += 1.0


def collapsed(cube: Cube) -> None:
    layer = cube.item.data.uv_layers[0]
    layer.uv.foreach_set("vector", np.zeros(2 * len(layer.uv), np.float32))


def whole(cube: Cube) -> None:
    """The UV map as it is."""


@pytest.mark.parametrize(
    ("change", "remark"),
    [
        (whole, ""),
        (without_uv_map, "UV map of Cube is not there"),
        (overlapping, "UV map of Cube overlaps"),
        (in_another_tile, "UV map of Cube reaches beyond its first tile"),
        (collapsed, "UV map of Cube has faces without area"),
    ],
)
@pytest.mark.parametrize("modifier", ["", "SUBSURF", "TRIANGULATE"])
@pytest.mark.filterwarnings("ignore:The UV map")
def test_a_place_is_baked_where_it_lies(
    cube: Cube, change: object, remark: str, modifier: str, tmp_path: Path
) -> None:
    change(cube)
    if modifier:
        cube.item.modifiers.new("modifier", modifier)
        cube.item.hide_render = True
    cube.link(cube.coordinates("Object"), "Base Color")
    found = baked(tmp_path)
    assert [remark in each for each in found.remarks] == [True] * bool(remark)
    assert (found.corners is None) == (not remark)
    texels, middle = in_middles(found, (0, ("base_color",)), cube.item)
    np.testing.assert_allclose(texels, middle, atol=BESIDE)


def test_values_share_a_picture(cube: Cube, tmp_path: Path) -> None:
    place = cube.coordinates("Object")
    for axis, name in (("X", "Roughness"), ("Z", "Alpha")):
        cube.link(cube.part(place, axis), name)
    cube.link(place, "Metallic")  # as a value: the mean of its parts
    ((key, _),) = (found := baked(tmp_path)).pictures.items()
    assert key == (0, ("metallic", "roughness", "alpha"))
    texels, middle = in_middles(found, key, cube.item)
    wanted = np.stack([middle.mean(axis=-1), middle[:, 0], middle[:, 2]], axis=-1)
    np.testing.assert_allclose(texels, wanted, atol=BESIDE)


def test_inputs_within_nested_groups_are_baked(cube: Cube, tmp_path: Path) -> None:
    """The BSDF is in a group in a group, and what it takes comes from outside."""
    inner = None
    for _ in range(2):
        tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
        tree.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
        tree.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
        begin, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        node = tree.nodes.new("ShaderNodeGroup" if inner else "ShaderNodeBsdfPrincipled")
        if inner:
            node.node_tree = inner
        tree.links.new(begin.outputs[0], node.inputs[0])
        tree.links.new(node.outputs[0], end.inputs[0])
        inner = tree
    group = cube.tree.nodes.new("ShaderNodeGroup")
    group.node_tree = inner
    cube.link(cube.coordinates("Object"), group.inputs[0])
    cube.link(group.outputs[0], cube.tree.get_output_node("CYCLES").inputs["Surface"])
    texels, middle = in_middles(baked(tmp_path), (0, ("base_color",)), cube.item)
    np.testing.assert_allclose(texels, middle, atol=BESIDE)


def test_each_slot_has_its_own_picture_and_their_places_may_overlap(cube: Cube, tmp_path: Path) -> None:
    overlapping(cube)
    other = cube.material.copy()
    cube.item.data.materials.append(other)
    cube.item.data.materials.append(cube.material)  # once more
    cube.link(cube.coordinates("Object"), "Base Color")
    cube.material, cube.tree = other, other.node_tree
    cube.bsdf = cube.tree.nodes["Principled BSDF"]
    cube.link(cube.part(cube.coordinates("Object"), "X"), "Roughness")
    cube.item.data.polygons[1].material_index = 1
    for number in (2, 3, 4, 5):
        cube.item.data.polygons[number].material_index = 3
    cube.item.data.materials.append(None)
    found = baked(tmp_path)
    assert found.uv_map == "UVMap"
    assert found.pictures.keys() == {(0, ("base_color",)), (1, ("roughness",))}
    colors, middle = in_middles(found, (0, ("base_color",)), cube.item)
    np.testing.assert_allclose(colors[:2], middle[:2], atol=BESIDE)
    values, _ = in_middles(found, (1, ("roughness",)), cube.item)
    np.testing.assert_allclose(values[2:4, 0], middle[2:4, 0], atol=BESIDE)


def test_random_numbers_are_those_of_the_object(cube: Cube, tmp_path: Path) -> None:
    cube.link(cube.add("ObjectInfo").outputs["Random"], "Roughness")
    first = baked(tmp_path).pictures[0, ("roughness",)].max()
    other = cube.item.copy()
    bpy.context.collection.objects.link(other)
    assert baked(tmp_path).pictures[0, ("roughness",)].max() == first
    assert baked(tmp_path, item=other.name).pictures[0, ("roughness",)].max() != first


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("change", [whole, without_uv_map])
@pytest.mark.filterwarnings("ignore:The UV map")
def test_a_baked_normal_is_the_one_that_was_given(
    cube: Cube, change: object, mirrored: bool, tmp_path: Path
) -> None:
    """A normal in the object's coordinates, baked, is by the tangents of Cycles the same again."""
    change(cube)
    if mirrored and cube.item.data.uv_layers:
        for each in cube.item.data.uv_layers[0].uv:
            each.vector.x = 1.0 - each.vector.x
    given = cube.add("NormalMap", space="OBJECT")
    given.inputs["Color"].default_value = (0.9, 0.7, 0.8, 1.0)
    cube.link(given.outputs[0], "Normal")
    found = baked(tmp_path)
    ((key, texels),) = found.pictures.items()
    assert key == (0, ("normal",))
    mesh = cube.item.data
    if found.corners is not None:
        mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", found.corners.ravel())
    mesh.calc_tangents(uvmap="UVMap")
    wanted = np.array([0.8, 0.4, 0.6]) / np.linalg.norm([0.8, 0.4, 0.6])
    seen = 0
    for polygon in mesh.polygons:
        loop = mesh.loops[polygon.loop_start]
        uv = np.mean([mesh.uv_layers["UVMap"].uv[each].vector[:] for each in polygon.loop_indices], axis=0)
        decoded = 2.0 * sample(ON_PICTURE, np.pad(texels, ((0, 0), (0, 0), (0, 1))), uv)[:3] - 1.0
        frame = np.array([loop.tangent[:], loop.bitangent[:], loop.normal[:]])
        if frame[2] @ wanted < 0.1:
            continue  # Cycles turns normals that face away
        np.testing.assert_allclose(decoded @ frame, wanted, atol=1e-3)
        seen += 1
    assert seen == 3


def test_the_file_stays_as_it_was(cube: Cube, tmp_path: Path) -> None:
    cube.item.modifiers.new("Subdivision", "SUBSURF")
    cube.item.hide_render = True
    picture = bpy.data.images.new("theirs", 4, 4)
    cube.tree.nodes.active = cube.add("TexImage", image=picture)
    cube.link(cube.add("TexNoise").outputs["Color"], "Base Color")
    before = open_file_state()
    pixels = list(picture.pixels)
    drain(bake_inputs("Cube", SETTINGS, tmp_path / "a.exr", force=False))
    assert open_file_state() == before
    assert list(picture.pixels) == pixels


def test_a_linked_object_is_baked(cube: Cube, tmp_path: Path) -> None:
    cube.link(cube.coordinates("Object"), "Base Color")
    item = linked_cube(tmp_path / "library.blend")
    bpy.context.collection.objects.link(item)
    texels, middle = in_middles(baked(tmp_path), (0, ("base_color",)), item)
    np.testing.assert_allclose(texels, middle, atol=BESIDE)


def test_a_curve_is_baked(cube: Cube, tmp_path: Path) -> None:
    bpy.ops.curve.primitive_bezier_circle_add()
    curve = bpy.context.object
    curve.data.bevel_depth = 0.2
    curve.data.materials.append(cube.material)
    cube.link(cube.coordinates("Object"), "Base Color")
    found = baked(tmp_path, BakedInputsSettings(size=512, samples=1), curve.name)
    texels, middle = in_middles(found, (0, ("base_color",)), curve)
    np.testing.assert_allclose(texels, middle, atol=BESIDE)


def test_what_depends_on_the_view_is_told(cube: Cube, tmp_path: Path) -> None:
    cube.link(cube.add("LayerWeight").outputs["Facing"], "Roughness")
    with pytest.warns(match="depends on the view by Layer Weight: it is baked as seen from straight above"):
        found = baked(tmp_path)
    # Seen from straight above, no place faces away
    np.testing.assert_allclose(found.pictures[0, ("roughness",)], 0.0, atol=1e-5)


def test_the_command_bakes(cube: Cube, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    cube.link(cube.add("TexNoise").outputs["Color"], "Base Color")
    path = tmp_path / "a.exr"
    argv = ("inputs", "Cube", "--size", "32", "--samples", "1", "-o", str(path))
    assert json_result(capfd, *argv)["pictures"] == 1
    (picture,) = pictures_of(principled(cube.material))
    assert read_baked_inputs(path).pictures[0, picture].shape == (32, 32, 3)
    for name, sentence in (("Cub", "no object Cub (did you mean Cube?)"), ("Light", "needs a bake")):
        error = json_result(capfd, "inputs", name, "-o", str(tmp_path / "b.exr"))["error"]
        assert sentence in error, json.dumps(error)


def test_what_has_no_faces_is_refused(cube: Cube, tmp_path: Path) -> None:
    cube.link(cube.add("TexNoise").outputs["Color"], "Base Color")
    cube.item.data.clear_geometry()
    with pytest.raises(SceneError, match="Cube has no faces"):
        baked(tmp_path)


@pytest.mark.filterwarnings("ignore:The UV map of Cube reaches beyond")
def test_tiles_of_an_image_are_baked(cube: Cube, tmp_path: Path) -> None:
    """A face on the second tile of a UDIM image has that tile's colour, on an unwrapping of its own."""
    for number, grey in ((1001, 51), (1002, 204)):
        write_png(tmp_path / f"tile.{number}.png", np.full((4, 4, 3), grey, np.uint8))
    image = bpy.data.images.load(str(tmp_path / "tile.1001.png"))
    image.source, image.colorspace_settings.name = "TILED", "Non-Color"
    image.tiles.new(tile_number=1002)
    cube.link(cube.add("TexImage", image=image).outputs["Color"], "Base Color")
    mesh = cube.item.data
    for corner in mesh.polygons[2].loop_indices:
        mesh.uv_layers[0].uv[corner].vector.x += 1.0
    texels, middle = in_middles(baked(tmp_path), (0, ("base_color",)), cube.item)
    is_second = np.all(np.isclose(middle @ mesh.polygons[2].normal, 1.0, atol=0.01)[:, None], axis=1)
    assert np.count_nonzero(is_second) == 2
    # Half the precision of 8 bits
    wanted = np.where(is_second, 0.8, 0.2)[:, None] * np.ones(3)
    np.testing.assert_allclose(texels, wanted, atol=2e-3)


def test_a_linked_material_is_baked(cube: Cube, tmp_path: Path) -> None:
    cube.link(cube.coordinates("Object"), "Base Color")
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "library.blend"))
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.materials = ["Material"]
    item = bpy.context.object
    item.data.materials[0] = wanted.materials[0]
    texels, middle = in_middles(baked(tmp_path), (0, ("base_color",)), item)
    np.testing.assert_allclose(texels, middle, atol=BESIDE)

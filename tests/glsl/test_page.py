"""What a web page holds, without a browser."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.companded import STEPS
from rsibr.rsibr_addon.core.errors import RangeError, RsibrError, RsibrWarning
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import Borders, MipLook
from rsibr.rsibr_addon.core.maps.octahedral import direction_from_uv, uv_from_direction
from rsibr.rsibr_addon.device.kinds.mip_chain import GpuMipChain
from rsibr.rsibr_addon.device.textures import GpuTexture
from rsibr.rsibr_addon.files.png import png_of
from rsibr.rsibr_addon.host.meshes import TriangleMesh, load_mesh, mesh_row
from rsibr.rsibr_addon.tasks.export.page import contents, meshes, own_objects
from rsibr.rsibr_addon.tasks.export.page.contents import packed_texture
from rsibr.rsibr_addon.tasks.export.page.meshes import in_order_of_use, made_normals, packed_mesh
from rsibr.rsibr_addon.tasks.export.page.named import named_meshes
from rsibr.rsibr_addon.tasks.export.page.parameters import block_of, parameters
from rsibr.tests.engine_light import sky_file
from rsibr.tests.files.test_export import CHAIN, chain_file
from rsibr.tests.files.test_packed_arrays import unpacked


def content_of(page: Path) -> dict[str, Any]:
    found = re.search(r'<script id="content" type="application/json">(.*?)</script>', page.read_text(), re.S)
    return json.loads(found[1])


@pytest.mark.slow
def test_a_page_needs_nothing_else(tmp_path: Path) -> None:
    source, page = str(chain_file(tmp_path)), tmp_path / "look.html"
    assert run(["export", source, "-o", str(page), "--roughness", "0.3"]) == 0
    text = page.read_text()
    content = content_of(page)
    plain = re.sub('<script id="content".*?</script>', "", text, flags=re.S)
    assert not re.search(r"https?:|src\s*=|href\s*=|\bimport\b|url\(|fetch\(", plain)
    assert len(plain) < 5e4
    assert next(each for each in content["parameters"] if each["name"] == "roughness")["start"] == 0.3
    assert len(text) - len(json.dumps(content["textures"])) < 5e5
    assert "error" in text
    assert run(["export", str(page.with_name("none.exr")), "-o", str(tmp_path / "new.html")]) == 1
    assert run(["export", source, "-o", str(page)]) == 1
    assert page.read_text() == text
    assert run(["export", source, "-o", str(page), "--force", "--metallic", "1"]) == 1


def applied(told: dict[str, Any], values: list[float], block: np.ndarray) -> None:
    for each, value in zip(told["sets"], values, strict=True):
        for entry, column in zip(each["entries"], np.array(each["values"]).T, strict=True):
            block[entry] = np.interp(value, each["at"], column)


def test_sliders_set_the_block_as_looks_do() -> None:
    drawable, look = GpuMipChain(CHAIN), MipLook(f0=(0.1, 0.2, 0.3))
    told = {each["name"]: each for each in parameters(drawable, look)}
    assert list(told) == [
        "f0",
        "kd",
        "roughness",
        "borders",
        "antialiased",
        "room",
    ]  # roughness chooses the mip
    assert told["roughness"]["start"] == 0.0
    block = block_of(drawable.inputs(look))
    applied(told["kd"], [0.25, 0.5, 1.0], block)
    applied(told["roughness"], [0.4], block)
    applied(told["borders"], [list(Borders).index(Borders.CLAMPED)], block)
    applied(told["antialiased"], [0.0], block)
    wanted = replace(look, kd=(0.25, 0.5, 1.0), roughness=0.4, borders=Borders.CLAMPED, antialiased=False)
    np.testing.assert_allclose(block, block_of(drawable.inputs(wanted)), atol=1e-2)
    exact = [entry for entry in range(len(block)) if entry not in told["roughness"]["sets"][0]["entries"]]
    np.testing.assert_allclose(block[exact], block_of(drawable.inputs(wanted))[exact], atol=1e-6)


def test_a_chain_without_roughness_has_a_slider_of_mips() -> None:
    told = parameters(GpuMipChain(MipChain(CHAIN.mips, CHAIN.harmonics, None)), MipLook())
    (mip,) = (each for each in told if each["name"] == "mip")
    assert mip["sets"][0]["at"][-1] == 3.0  # no slider beyond the last of four


def codes_of(part: dict[str, Any], width: int) -> np.ndarray:
    codes = unpacked(part["codes"], signed=True).reshape(3, -1, width)
    if part["relative"]:
        codes[[0, 2]] += codes[1]
    return codes


def test_texels_are_rounded_as_promised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "EXACT", 0)
    texture = GpuMipChain(CHAIN).textures[0]
    wanted = np.moveaxis(texture.values[..., :3], -1, 0)
    packed, error = packed_texture(texture)
    width, height, layers = packed["size"]
    (part,) = packed["parts"]
    values = part["unit"] * np.sinh(codes_of(part, width) / STEPS)
    assert (height, layers) == (wanted.shape[1], 0)
    assert np.all(np.abs(values - wanted) <= 1.01 * (wanted + part["unit"]) / (2.0 * STEPS))
    relative = np.sqrt(np.mean((values - wanted) ** 2) / np.mean(wanted**2))
    assert np.isclose(relative, error, rtol=1e-3)
    assert 1e-4 < error < 1.0 / STEPS
    rounded, exact = packed_texture(texture, exact_from=5)[0]["parts"]
    assert codes_of(rounded, width).shape[1] == 5
    assert len(packed_texture(texture, exact_from=0)[0]["parts"]) == 1
    bits = codes_of(exact, width).astype(np.int16)
    assert np.array_equal(bits.view(np.float16), wanted[:, 5:].astype(np.float16))


def mesh_of(packed: dict[str, Any]) -> TriangleMesh:
    """Vertex by vertex, the way back."""
    triangles = unpacked(packed["triangles"], signed=False).T
    positions = unpacked(packed["positions"], signed=True).T
    known, across = 0, dict[frozenset[int], int]()
    for triangle in triangles.tolist():
        corners = list(zip(triangle, triangle[1:] + triangle[:1], triangle[2:] + triangle[:2], strict=True))
        for vertex, a, b in corners:
            if vertex != known:
                continue
            near = [each for each in (a, b, known - 1) if 0 <= each < known]
            if frozenset((a, b)) in across:
                positions[known] += positions[a] + positions[b] - positions[across[frozenset((a, b))]]
            elif near:
                positions[known] += positions[near[0]]
            positions[known] = (positions[known] + 2**15) % 2**16 - 2**15
            known += 1
        across |= {frozenset((a, b)): vertex for vertex, a, b in corners}
    codes = unpacked(packed["normals"], signed=True).T
    codes += np.rint(8191 * (2.0 * uv_from_direction(made_normals(positions, triangles)) - 1.0)).astype(int)
    normals = direction_from_uv(0.5 + 0.5 * codes / 8191.0)
    return TriangleMesh("unpacked", positions / 32767.0, normals, triangles)


def bumpy(count: int) -> TriangleMesh:
    """A closed surface of triangles in no order, whose normals are not those of its triangles."""
    rng = np.random.default_rng(1)
    points = rng.standard_normal((count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    normals = points + 0.3 * rng.standard_normal((count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[:4] = [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0)]
    triangles = rng.permutation(count - 2)[:, None] + np.arange(3)
    return TriangleMesh("Rock", 0.9 * points, normals, triangles.astype(np.int32))


def test_a_mesh_comes_back() -> None:
    """Coordinates but for half a step; normals but for half a step along each axis of their map."""
    rock = bumpy(300)
    order, triangles = in_order_of_use(rock.triangles)
    assert np.array_equal(order[triangles], rock.triangles)
    used = TriangleMesh("Rock", rock.positions[order], rock.normals[order], triangles)
    back = mesh_of(packed_mesh(used))
    assert np.array_equal(back.triangles, triangles)
    assert np.abs(back.positions - used.positions).max() < 0.501 / 32767
    # Of a circle whose half is at least one long
    assert np.linalg.norm(back.normals - used.normals, axis=1).max() < 2.0 / 8191


def test_vertices_that_no_triangle_has_are_left_out() -> None:
    order, triangles = in_order_of_use(np.array([[7, 2, 5], [5, 2, 9]], np.int32))
    assert (order.tolist(), triangles.tolist()) == ([7, 2, 5, 9], [[0, 1, 2], [2, 1, 3]])


def test_normals_of_a_symmetric_mesh_do_not_hang_on_the_last_digit() -> None:
    """Those straight down the middle, where the map of normals is folded, are the same for noise of 1e-12."""
    roof = np.array([[-9, 0, -5], [9, 0, -5], [0, -9, -6], [0, 9, -6]], np.int64) * 1000
    triangles = np.array([[0, 3, 2], [1, 2, 3]])
    made = made_normals(roof, triangles)
    assert made[2, 0] == 0.0
    assert made[2, 2] < 0.0


def test_a_mesh_that_is_too_large_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    corners = np.eye(3, dtype=np.float32)
    mesh = TriangleMesh("Rock", corners, -corners, np.array([[0, 1, 2]], np.int32))
    back = mesh_of(packed_mesh(mesh))
    assert np.array_equal(back.positions, corners)
    assert np.allclose(back.normals, -corners)
    monkeypatch.setattr(meshes, "MOST_TRIANGLES", 0)
    with pytest.raises(RangeError, match=r"Rock has 1 triangles, and a page takes 0 at most: decimate it\."):
        packed_mesh(mesh)


def test_a_texture_that_few_devices_take_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "WIDEST", 3)
    packed_texture(GpuTexture("map", np.ones((3, 3, 4), np.float32)))
    with pytest.warns(RsibrWarning, match="a texture of 2 x 4 texels, and many devices take 3 at most"):
        packed_texture(GpuTexture("map", np.ones((4, 2, 4), np.float32)))


def mesh_in(page: Path) -> dict[str, Any]:
    (shown,) = content_of(page)["objects"]
    return shown["mesh"]


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_the_operator_shows_the_selected_objects(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    cube = bpy.context.object
    bpy.ops.rsibr.assign(filepath=str(chain_file(tmp_path)))
    assert bpy.ops.rsibr.export_page(filepath=str(page)) == {"FINISHED"}
    alone = mesh_in(page)
    assert alone["triangles"]["shape"] == [3, 12]
    other = cube.copy()
    bpy.context.collection.objects.link(other)
    other.location, other.scale = (4.0, 0.0, 0.0), (-1.0, 1.0, 2.0)
    other.select_set(True)
    with pytest.raises(RuntimeError, match=r"page\.html exists"):
        bpy.ops.rsibr.export_page(filepath=str(page))
    both = tmp_path / "both.html"
    assert bpy.ops.rsibr.export_page(filepath=str(both)) == {"FINISHED"}
    mesh = mesh_of(mesh_in(both))
    corners = mesh.positions[mesh.triangles]
    facets = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facets /= np.linalg.norm(facets, axis=1, keepdims=True)
    normals = mesh.normals[mesh.triangles[:, 0]]
    assert len(facets) == 24
    assert np.all(np.sum(facets * normals, axis=1) > 0.99)  # also of the mirrored one
    assert np.isclose(np.linalg.norm(mesh.positions, axis=1).max(), 1.0, atol=1e-4)


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_the_operator_shows_the_scene_s_view_and_says_where(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    bpy.ops.rsibr.assign(filepath=str(chain_file(tmp_path)))
    view = bpy.context.scene.view_settings
    monkeypatch.setattr(view, "exposure", 1.5)
    for transform, shown in (("AgX", "AgX"), ("Raw", "Standard")):
        monkeypatch.setattr(view, "view_transform", transform)
        page = tmp_path / f"{transform}.html"
        bpy.ops.rsibr.export_page(filepath=str(page))
        assert f"Wrote {page}" in capfd.readouterr().out
        content = content_of(page)
        assert (content["display"], content["exposure"]) == (shown, 1.5)
    bpy.ops.rsibr.export_page(
        filepath=str(tmp_path / "own.html"), view_transform="Khronos PBR Neutral", exposure=0.0
    )
    content = content_of(tmp_path / "own.html")
    assert (content["display"], content["exposure"]) == ("Khronos PBR Neutral", 0.0)


@pytest.mark.slow
@pytest.mark.usefixtures("view")
def test_the_operator_takes_the_materials_of_slots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cube, light = bpy.context.object, tmp_path / "light.rsibr.exr"
    environment = str(sky_file(tmp_path))
    bake = ["bake", "kernel-pyramid", "--environment", environment, "--size", "32", "-o", str(light)]
    assert run(bake) == 0
    bpy.ops.rsibr.assign(filepath=str(light))
    bpy.ops.rsibr.export_page(filepath=str(tmp_path / "plain.html"), background="light", floor=True)
    plain = content_of(tmp_path / "plain.html")
    assert plain["matte"]["light"]["size"] == [258, 130, 0]
    assert np.isclose(plain["matte"]["floor"]["height"], -np.sqrt(1.0 / 3.0))
    assert {"base_color", "roughness"} <= {each["name"] for each in plain["parameters"]}
    tree = cube.active_material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("colours", 4, 4)
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    cube.data.materials.append(second := bpy.data.materials.new("second"))
    again = second.node_tree.nodes.new("ShaderNodeTexImage")
    again.image = node.image
    second.node_tree.links.new(again.outputs["Color"], second.node_tree.nodes["Principled BSDF"].inputs[0])
    encoded: list[np.ndarray] = []
    monkeypatch.setattr(own_objects, "png_of", lambda texels: encoded.append(texels) or png_of(texels))
    cube.data.polygons[0].material_index = 1
    other = cube.copy()
    bpy.context.collection.objects.link(other)
    other.select_set(True)
    bpy.ops.rsibr.export_page(filepath=str(tmp_path / "own.html"))
    own = content_of(tmp_path / "own.html")
    assert [each["images"] for each in own["materials"]] == [[0], [0]]
    assert len(encoded) == 1
    assert [each["slots"] for each in own["objects"]] == 2 * [[[0, 30, 0], [30, 36, 1]]]
    assert (len(own["images"]), own["images"][0]["srgb"], own["parameters"]) == (1, True, [])
    assert own["programs"] != plain["programs"]


def scene_file(folder: Path) -> Path:
    """Two meshes of other materials beside each other, and a light."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for place, name in enumerate(("Cup, red", "Cup, blue")):
        bpy.ops.mesh.primitive_cube_add(location=(3.0 * place, 0.0, 0.0))
        bpy.context.object.name = name
        material = bpy.data.materials.new(name)
        material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.2 + 0.5 * place
        bpy.context.object.data.materials.append(material)
    bpy.ops.object.light_add()
    file = folder / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return file


@pytest.mark.slow
def test_the_command_shows_objects_of_a_blender_file(tmp_path: Path) -> None:
    page, cups = tmp_path / "page.html", f"{scene_file(tmp_path)}:Cup*"
    assert run(["export", str(chain_file(tmp_path)), "--mesh", cups, "-o", str(page)]) == 0
    assert mesh_in(page)["triangles"]["shape"] == [3, 24]


def test_objects_of_a_blender_file_are_shown_as_they_stand_there(tmp_path: Path) -> None:
    """In their own materials where the kind has such, by name or pattern."""
    file = scene_file(tmp_path)
    own, _ = named_meshes([f"{file}:Cup*"], "kernel_pyramid", PrincipledLook())
    assert {each.mesh.name: each.matrix[0, 3] for each in own} == {"Cup, red": 0.0, "Cup, blue": 3.0}
    named = [f"{file}:Cup, red", f"{file}:Cup, blue"]
    alike, look = named_meshes(named, "kernel_pyramid", PrincipledLook(own=False))
    assert look == PrincipledLook(own=False)
    assert len(alike.triangles) == 24
    plain, look = named_meshes(named[1:], "kernel_pyramid", PrincipledLook())
    assert len(plain.triangles) == 12  # one plain material keeps its sliders
    assert np.isclose(look.roughness, 0.7)
    of_chain, look = named_meshes(named, "mip_chain", MipLook())
    assert (len(of_chain.triangles), look) == (24, MipLook())


def test_meshes_that_are_no_objects_stand_in_a_row() -> None:
    row, sphere = mesh_row(["sphere", "sphere", "sphere"]), load_mesh("sphere")
    count = len(sphere.positions)
    middle = row.positions[count : 2 * count]
    radius = 1.0 / (1.0 + 2.1)
    np.testing.assert_allclose(middle, radius * sphere.positions, atol=1e-6)
    assert np.array_equal(row.triangles[-len(sphere.triangles) :], sphere.triangles + 2 * count)


@pytest.mark.parametrize(
    ("meshes", "said"),
    [
        (["{file}"], "is a file of objects: name one"),
        (["{file}:Cup"], "shows no object Cup: name"),
        (["{file}:Cup, rad"], "shows no object Cup, rad (did you mean Cup, red?)"),
        (["{file}:*Light"], "shows no object *Light"),
        (["{file}:Cup*", "sphere"], "are not of one Blender file"),
        (["{file}:Cup*", "other.blend:Cup"], "are not of one Blender file"),
        (["none.blend:Cup"], "There is no file none.blend"),
    ],
)
def test_meshes_that_no_page_shows_are_refused(meshes: list[str], said: str, tmp_path: Path) -> None:
    specs = [mesh.format(file=scene_file(tmp_path)) for mesh in meshes]
    with pytest.raises(RsibrError, match=re.escape(said)):
        named_meshes(specs, "mip_chain", MipLook())

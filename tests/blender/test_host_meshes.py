"""Meshes: exact spheres, files, fitting, split normals, and nothing left behind in the Blender file."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, SceneError
from rsibr.rsibr_addon.host.meshes import (
    TriangleMesh,
    add_mesh,
    content_of,
    evaluated_mesh,
    load_mesh,
    mesh_from_object,
)
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.tests.measurements import measurement

CORNER = """
v 0 0 0
v 4 0 0
v 0 2 0
v 0 0 2
vn 0 0 1
vn 0 1 0
f 1//1 2//1 3//1
f 1//2 4//2 2//2
"""
"""Two triangles that share an edge and disagree about its normal; extent 4 x 2 x 2."""


def face_normals(mesh: TriangleMesh) -> np.ndarray:
    """Twice each triangle's area times its unit normal, shape (T, 3)."""
    a, b, c = mesh.positions[mesh.triangles].astype(np.float64).transpose(1, 0, 2)
    return np.cross(b - a, c - a)


def names_in_file() -> set[str]:
    """Everything in the Blender file, as text."""
    collections = [getattr(bpy.data, name) for name in dir(bpy.data)]
    return {repr(item) for c in collections if isinstance(c, bpy.types.bpy_prop_collection) for item in c}


def write(folder: Path, text: str) -> Path:
    path = folder / "given.obj"
    path.write_text(text)
    return path


def test_the_sphere_is_round() -> None:
    mesh = load_mesh("sphere")
    np.testing.assert_allclose(np.linalg.norm(mesh.positions, axis=-1), 1.0, atol=2e-7)  # float32
    np.testing.assert_array_equal(mesh.normals, mesh.positions)
    outwards = face_normals(mesh)
    distance = np.einsum("ij,ij->i", outwards, mesh.positions[mesh.triangles[:, 0]])
    distance /= np.linalg.norm(outwards, axis=-1)
    # The sphere's farthest point from the triangles' planes: what the module promises.
    assert 0.0 < 1.0 - distance.min() < 9.7e-5


def test_the_sphere_is_closed() -> None:
    triangles = load_mesh("sphere").triangles
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    rings, sectors = 160, 320
    # A ring at a pole is one point: its vertices count as one.
    edges = np.where(edges < sectors, 0, edges)
    edges = np.where(edges >= rings * sectors, rings * sectors, edges)
    # Each edge is passed once in each direction, by the triangles on its two sides.
    passed, back = np.sort(edges @ (1 << 20, 1)), np.sort(edges[:, ::-1] @ (1 << 20, 1))
    np.testing.assert_array_equal(passed, back)
    assert np.all(np.diff(passed) > 0)


def test_suzanne_fits_and_faces_outwards() -> None:
    mesh = load_mesh("monkey")
    assert np.linalg.norm(mesh.positions, axis=-1).max() == pytest.approx(1.0, abs=2e-7)
    np.testing.assert_allclose(mesh.positions.min(axis=0), -mesh.positions.max(axis=0), atol=2e-7)
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=-1), 1.0, atol=1e-6)
    shading = mesh.normals[mesh.triangles].sum(axis=1)
    assert np.einsum("ij,ij->i", face_normals(mesh), shading).min() > 0.0
    # Smooth, so no vertex is split: 507 vertices, 1005 edges, 500 faces, three times subdivided,
    # each time V' = V + E + F.
    assert len(mesh.positions) == 31658
    # Her chin is in front (-Y) of her ears' tips, and lower than the crown of her head.
    ear, chin = mesh.positions[mesh.positions[:, 0].argmax()], mesh.positions[mesh.positions[:, 2].argmin()]
    assert chin[1] < ear[1]


def test_a_file_keeps_its_normals_and_fits(tmp_path: Path) -> None:
    mesh = load_mesh(str(write(tmp_path, CORNER)))
    assert len(mesh.triangles) == 2
    # The shared edge's two vertices are split in two, the others are not.
    assert len(mesh.positions) == 6
    # Y up becomes Z up: (x, y, z) -> (x, -z, y). Blender packs a file's normals into 2 x 16 bits.
    upper, lower = (mesh.normals[triangle] for triangle in mesh.triangles)
    np.testing.assert_allclose(upper, np.broadcast_to((0.0, -1.0, 0.0), (3, 3)), atol=1e-4)
    np.testing.assert_allclose(lower, np.broadcast_to((0.0, 0.0, 1.0), (3, 3)), atol=1e-4)
    # Every vertex is a corner of the box of 4 x 2 x 2, sqrt(6) away from its centre.
    expected = np.array([(-2, 1, -1), (2, 1, -1), (-2, 1, 1), (-2, -1, -1)]) / np.sqrt(6.0)
    for vertex in expected:
        assert np.linalg.norm(mesh.positions - vertex, axis=-1).min() < 2e-7


def test_a_file_without_normals_is_shaded_smooth(tmp_path: Path) -> None:
    tent = "v -1 0 0\nv 1 0 0\nv 0 1 1\nv 0 1 -1\nf 1 2 3\nf 2 1 4\n"
    mesh = load_mesh(str(write(tmp_path, tent)))
    assert len(mesh.positions) == 4
    assert not np.allclose(mesh.normals[mesh.triangles[0]], face_normals(mesh)[0])


@pytest.mark.parametrize("again", ["f 1 2 3", "f 3 1 2", "f 3 2 1", "f 2 2 3", "f 1 2 3 1"])
def test_a_face_that_is_there_twice_or_is_none_is_left_out(tmp_path: Path, again: str) -> None:
    text = "v -1 0 0\nv 1 0 0\nv 0 1 1\nv 0 1 -1\nf 1 2 3\nf 2 1 4\n"
    mesh, expected = (load_mesh(str(write(tmp_path, each))) for each in (text + again, text))
    np.testing.assert_array_equal(mesh.triangles, expected.triangles)
    np.testing.assert_array_equal(mesh.normals, expected.normals)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("no Wavefront file at all\n", "holds no faces"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "holds no faces"),
        ("v 0 0 0\nv 1 nan 0\nv 0 inf 0\nf 1 2 3\n", "holds 2 coordinates that are NaN or infinite"),
        ("v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n", "are one point"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "holds no faces"),
    ],
)
def test_a_bad_file_is_refused_by_name(tmp_path: Path, text: str, complaint: str) -> None:
    before = names_in_file()
    with pytest.raises(InputFileError, match=complaint) as caught:
        load_mesh(str(write(tmp_path, text)))
    assert "given.obj" in str(caught.value)
    assert names_in_file() == before


def test_a_file_of_bytes_is_refused_by_name(tmp_path: Path) -> None:
    (tmp_path / "given.obj").write_bytes(bytes(range(1, 256)) * 20)
    with pytest.raises(InputFileError, match=r"given\.obj (cannot be read|holds no faces)"):
        load_mesh(str(tmp_path / "given.obj"))


def test_a_missing_file_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(InputFileError, match=r"no mesh .*absent\.obj: name sphere or monkey"):
        load_mesh(str(tmp_path / "absent.obj"))


TRIANGLES = {
    "given.ply": b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n2 0 0\n0 0 1\n3 0 1 2\n",
    "given.stl": b"solid\nfacet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 0 1\n"
    b"endloop\nendfacet\nendsolid\n",
    "given.obj": b"v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n",  # Y up
}


@pytest.mark.parametrize("name", TRIANGLES)
def test_each_format_stands_as_blender_reads_it(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(TRIANGLES[name])
    before = names_in_file()
    mesh = load_mesh(str(tmp_path / name))
    expected = np.array([(-1.0, 0.0, -0.5), (1.0, 0.0, -0.5), (-1.0, 0.0, 0.5)]) / np.sqrt(1.25)
    np.testing.assert_allclose(mesh.positions[mesh.triangles[0]], expected, atol=1e-6)
    np.testing.assert_allclose(mesh.normals[0], (0.0, -1.0, 0.0), atol=1e-4)
    assert names_in_file() == before


@pytest.mark.parametrize("name", ["given.ply", "given.stl"])
def test_other_bytes_in_a_format_are_refused_by_name(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(bytes(range(1, 256)) * 20)
    with pytest.raises(InputFileError, match=rf"{name} (cannot be read|holds no faces)"):
        load_mesh(str(tmp_path / name))


def test_a_format_that_is_not_read_is_named(tmp_path: Path) -> None:
    (tmp_path / "given.glb").write_bytes(b"glTF")
    with pytest.raises(InputFileError, match=r"given\.glb is no OBJ, PLY or STL file by its name"):
        load_mesh(str(tmp_path / "given.glb"))


def test_the_artists_file_is_left_alone(tmp_path: Path) -> None:
    cube = bpy.data.objects["Cube"]
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    before = names_in_file()
    load_mesh("monkey")
    load_mesh(str(write(tmp_path, CORNER + "usemtl painted\nf 1 2 3\n")))
    assert names_in_file() == before
    assert bpy.context.active_object is cube
    assert bpy.context.selected_objects == [cube]


def test_an_objects_mesh_has_its_modifiers_and_its_own_coordinates() -> None:
    cube = bpy.data.objects["Cube"]
    cube.location = (5.0, 6.0, 7.0)
    array = cube.modifiers.new("Array", "ARRAY")
    array.count = 2
    bpy.context.view_layer.update()
    mesh = mesh_from_object(cube, bpy.context.evaluated_depsgraph_get())
    assert len(mesh.triangles) == 24
    # Flat shaded: 4 vertices for each of 2 x 6 faces.
    assert len(mesh.positions) == 48
    np.testing.assert_allclose(mesh.positions.min(axis=0), -1.0)
    flat = face_normals(mesh) / np.linalg.norm(face_normals(mesh), axis=-1, keepdims=True)
    np.testing.assert_allclose(mesh.normals[mesh.triangles], np.repeat(flat[:, None], 3, axis=1), atol=1e-6)


def test_an_object_without_a_surface_is_refused() -> None:
    with pytest.raises(SceneError, match="Light has no surface"):
        mesh_from_object(bpy.data.objects["Light"], bpy.context.evaluated_depsgraph_get())


def test_a_mesh_goes_into_a_scene_and_comes_back_exactly() -> None:
    generator = np.random.default_rng(3)
    monkey = load_mesh("monkey")
    # Normals that no geometry implies.
    normals = monkey.normals + 0.3 * generator.standard_normal(monkey.normals.shape).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    bent = TriangleMesh("bent", monkey.positions, normals, monkey.triangles)
    with temporary_scene() as scene:
        item = add_mesh(scene, bent, bpy.data.materials["Material"])
        assert not item.data.validate()
        scene.view_layers[0].update()
        back = mesh_from_object(item, scene.view_layers[0].depsgraph)
        assert item.data.materials[0].name == "Material"
    np.testing.assert_array_equal(back.positions, bent.positions)
    np.testing.assert_array_equal(back.triangles, bent.triangles)
    np.testing.assert_allclose(back.normals, bent.normals, atol=2e-7)


def test_the_teapot_stands_upright() -> None:
    mesh = load_mesh(str(measurement("meshes/teapot_wdas.obj")))
    assert len(mesh.triangles) == 6320
    extent = np.ptp(mesh.positions, axis=0)
    # Its height, along Y in the file, is its smallest extent.
    assert extent[2] == extent.min()
    top = mesh.positions[mesh.positions[:, 2].argmax()]
    assert np.linalg.norm(top[:2]) < 0.2  # the lid's knob


def test_a_mesh_s_content_is_all_that_its_surface_depends_on() -> None:
    def content() -> bytes:
        depsgraph = bpy.context.evaluated_depsgraph_get()
        with evaluated_mesh(item, depsgraph) as mesh:
            return content_of(mesh)

    item = bpy.data.objects["Cube"]
    contents = [content()]
    item.update_tag(refresh={"DATA"})
    assert content() == contents[0]
    item.data.vertices[0].co.x -= 1e-3
    contents.append(content())
    item.data.shade_smooth()
    contents.append(content())
    item.data.flip_normals()
    contents.append(content())
    item.modifiers.new("Smooth", "SUBSURF")
    contents.append(content())
    assert len(set(contents)) == len(contents)

"""Meshes for textures: MikkTSpace's tangents beside Blender's, UV maps, slots, and no vertex too many."""

from collections.abc import Iterator

import bmesh
import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.host.mesh_arrays import split_vertices
from rsibr.rsibr_addon.host.textured_meshes import (
    MeshNeeds,
    TexturedMesh,
    textured_content_of,
    textured_mesh,
)

RENDERED = MeshNeeds(("",), ("",))
"""The map that is rendered with, with its tangents."""


@pytest.fixture
def monkey() -> Iterator[bpy.types.Mesh]:
    """Suzanne of triangles, with a UV map."""
    mesh = bpy.data.meshes.new("monkey")
    shape = bmesh.new()
    shape.loops.layers.uv.new("UVMap")
    bmesh.ops.create_monkey(shape, calc_uvs=True)
    bmesh.ops.triangulate(shape, faces=shape.faces)
    shape.to_mesh(mesh)
    shape.free()
    yield mesh
    bpy.data.meshes.remove(mesh)


def set_uv(mesh: bpy.types.Mesh, uv: np.ndarray, name: str = "UVMap") -> None:
    layer = mesh.uv_layers.get(name) or mesh.uv_layers.new(name=name)
    layer.uv.foreach_set("vector", uv.astype(np.float32).ravel())


def get_uv(mesh: bpy.types.Mesh) -> np.ndarray:
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uv)
    return uv.reshape(-1, 2)


def smooth(mesh: bpy.types.Mesh) -> None:
    mesh.shade_smooth()


def flat(mesh: bpy.types.Mesh) -> None:
    mesh.shade_flat()


def mirrored(mesh: bpy.types.Mesh) -> None:
    """Both halves have one side of the map, as where a texture is painted once for two sides."""
    mesh.shade_smooth()
    uv = get_uv(mesh)
    set_uv(mesh, np.stack([np.abs(uv[:, 0] - 0.5), uv[:, 1]], axis=1))


def folded(mesh: bpy.types.Mesh) -> None:
    mesh.shade_smooth()
    set_uv(mesh, get_uv(mesh) + np.random.default_rng(4).uniform(-0.05, 0.05, (len(mesh.loops), 2)))


def partly_without_extent(mesh: bpy.types.Mesh) -> None:
    mesh.shade_smooth()
    uv = get_uv(mesh).reshape(-1, 3, 2)
    uv[::20] = uv[::20, :1]
    set_uv(mesh, uv)


def torn(mesh: bpy.types.Mesh) -> None:
    """Each triangle has its own vertices, and their normals are the smooth ones."""
    mesh.shade_smooth()
    normals = np.array([each.vector for each in mesh.corner_normals])
    shape = bmesh.new()
    shape.from_mesh(mesh)
    bmesh.ops.split_edges(shape, edges=shape.edges)
    shape.to_mesh(mesh)
    shape.free()
    kept = mesh.attributes.new("custom_normal", "FLOAT_VECTOR", "CORNER")
    kept.data.foreach_set("vector", normals.ravel())


@pytest.mark.parametrize(
    "change", [smooth, flat, mirrored, folded, partly_without_extent, torn], ids=lambda each: each.__name__
)
def test_tangents_are_those_of_blender(monkey: bpy.types.Mesh, change: object) -> None:
    change(monkey)
    ours = textured_mesh(monkey, "monkey", RENDERED)
    corners = ours.triangles.ravel()
    monkey.calc_tangents(uvmap="UVMap")
    theirs = np.array([(*each.tangent, each.bitangent_sign) for each in monkey.loops])
    np.testing.assert_array_equal(ours.uv[corners, 0], get_uv(monkey))
    np.testing.assert_allclose(np.linalg.norm(ours.tangents[:, :3], axis=1), 1.0, atol=1e-6)
    is_defined = np.repeat(has_extent(ours), 3) & ~np.isin(corners, corners_without_extent(ours))
    # Where two sheets of Suzanne meet, Blender may have no normal, or none but 0 for a tangent
    is_defined &= ours.normals[corners].any(axis=1) & theirs[:, :3].any(axis=1)
    assert np.count_nonzero(is_defined) > 0.4 * len(corners)
    # Sums of a few unit vectors in single precision, of lengths down to a hundredth
    assert np.abs(ours.tangents[corners] - theirs)[is_defined].max() < 1e-3


def has_extent(mesh: TexturedMesh) -> np.ndarray:
    """Of each triangle, whether it has one in space and in the map: what has none takes any neighbour's."""
    doubled = []
    for corners in (
        mesh.positions[mesh.triangles],
        np.pad(mesh.uv[mesh.triangles, 0], [(0, 0), (0, 0), (0, 1)]),
    ):
        first, second = (corners[:, 1:] - corners[:, :1]).astype(float).swapaxes(0, 1)
        doubled.append(np.linalg.norm(np.cross(first, second), axis=1))
    return (doubled[0] > 1e-6) & (doubled[1] > 0.0)


def corners_without_extent(mesh: TexturedMesh) -> np.ndarray:
    """Vertices where the tangent depends on which triangle is looked at first."""
    placed = mesh.positions[mesh.triangles[~has_extent(mesh)]].reshape(-1, 3)
    return np.flatnonzero((mesh.positions[:, None] == placed).all(axis=2).any(axis=1))


def test_four_mirrored_quarters_have_tangents_of_their_own() -> None:
    """In the middle all corners are equal, but opposite quarters have opposite tangents."""
    mesh = bpy.data.meshes.new("quarters")
    points = [(x, y, 0) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    mesh.from_pydata(points, [], [(k, k + 1, k + 4, k + 3) for k in (0, 1, 3, 4)])
    vertex = np.empty(16, np.int32)
    mesh.loops.foreach_get("vertex_index", vertex)
    set_uv(mesh, np.abs(np.array(points)[vertex, :2]))
    ours = textured_mesh(mesh, "quarters", RENDERED)
    middle = ours.positions[ours.triangles].mean(axis=1)
    for triangle, (x, y, _) in zip(ours.triangles, middle, strict=True):
        expected = np.tile((np.sign(x), 0.0, 0.0, np.sign(x * y)), (3, 1))
        np.testing.assert_allclose(ours.tangents[triangle], expected, atol=1e-6)


def test_tangents_of_a_plane_are_the_direction_of_u() -> None:
    """A hexagon, whose map is turned by an angle and, on a copy beside it, mirrored too."""
    turns = np.arange(6) * np.pi / 3
    points = np.stack([np.cos(turns), np.sin(turns), 0.0 * turns], axis=1)
    mesh = bpy.data.meshes.new("hexagons")
    mesh.from_pydata([*points, *(points + (3.0, 0.0, 0.0))], [], [range(6), range(6, 12)])
    angle = 0.4
    along_u, along_v = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    uv = np.stack([points[:, :2] @ along_u, points[:, :2] @ along_v], axis=1)
    set_uv(mesh, np.concatenate([uv, uv * (-1.0, 1.0)]))
    ours = textured_mesh(mesh, "hexagons", RENDERED)
    assert len(ours.positions) == 12
    assert len(ours.triangles) == 8
    expected = np.where(ours.positions[:, :1] < 1.5, (*along_u, 0, 1), (*-along_u, 0, -1))
    np.testing.assert_allclose(ours.tangents, expected, atol=1e-6)


def corner_rows(mesh: TexturedMesh) -> np.ndarray:
    parts = (mesh.positions, mesh.normals, mesh.uv.reshape(len(mesh.uv), -1), mesh.tangents)
    return np.concatenate(parts, axis=1)[mesh.triangles.ravel()]


@pytest.mark.parametrize("change", [smooth, flat, mirrored, folded], ids=lambda each: each.__name__)
def test_vertices_are_split_only_where_corners_disagree(monkey: bpy.types.Mesh, change: object) -> None:
    change(monkey)
    ours = textured_mesh(monkey, "monkey", RENDERED)
    assert len(ours.positions) == len(np.unique(corner_rows(ours), axis=0))
    vertex = np.empty(len(monkey.loops), np.int32)
    monkey.loops.foreach_get("vertex_index", vertex)
    places = np.array([each.co for each in monkey.vertices], np.float32)
    np.testing.assert_array_equal(ours.positions[ours.triangles.ravel()], places[vertex])


def test_a_map_that_is_not_there_is_left_out_and_has_no_tangents(monkey: bpy.types.Mesh) -> None:
    ours = textured_mesh(monkey, "monkey", MeshNeeds(("absent", "UVMap", ""), ("absent",)))
    assert ours.uv_maps == ("UVMap",)
    np.testing.assert_array_equal(ours.uv[ours.triangles.ravel(), 0], get_uv(monkey))
    assert not ours.tangents.any()
    monkey.uv_layers.remove(monkey.uv_layers[0])
    ours = textured_mesh(monkey, "monkey", RENDERED)
    assert ours.uv_maps == ()
    assert not ours.tangents.any()


def test_the_map_that_the_mesh_renders_with_comes_first(monkey: bpy.types.Mesh) -> None:
    set_uv(monkey, 2.0 * get_uv(monkey), "Another")
    assert textured_mesh(monkey, "monkey", MeshNeeds(("", "Another"), (None,))).uv_maps == (
        "UVMap",
        "Another",
    )
    monkey.uv_layers["Another"].active_render = True
    ours = textured_mesh(monkey, "monkey", MeshNeeds(("", "UVMap"), (None,)))
    assert ours.uv_maps == ("Another", "UVMap")
    np.testing.assert_array_equal(ours.uv[:, 0], 2.0 * ours.uv[:, 1])
    assert ours.tangents is None


def test_each_slot_has_the_tangents_of_its_own_map(monkey: bpy.types.Mesh) -> None:
    monkey.shade_smooth()
    set_uv(monkey, get_uv(monkey) @ [[0.0, 1.0], [-1.0, 0.0]], "turned")
    slots = np.arange(len(monkey.polygons), dtype=np.int32) % 4
    monkey.polygons.foreach_set("material_index", slots)
    needs = MeshNeeds((), ("UVMap", None, "turned"))
    ours = textured_mesh(monkey, "monkey", needs)
    np.testing.assert_array_equal(ours.slots, slots)
    assert ours.uv.shape == (len(ours.positions), 0, 2)
    for slot, name in enumerate(("UVMap", None, "turned", "turned")):  # the last one is beyond what is needed
        its = ours.tangents[ours.triangles[slots == slot]]
        if name is None:
            assert not its.any()
        else:
            alone = textured_mesh(monkey, "monkey", MeshNeeds((), (name,)))
            np.testing.assert_array_equal(its, alone.tangents[alone.triangles[slots == slot]])


def test_content_is_all_that_the_mesh_depends_on(monkey: bpy.types.Mesh) -> None:
    contents = [textured_content_of(monkey, RENDERED)]
    assert textured_content_of(monkey, RENDERED) == contents[0]
    contents.append(textured_content_of(monkey, MeshNeeds(("",), (None,))))
    set_uv(monkey, get_uv(monkey) + 0.1)
    contents.append(textured_content_of(monkey, RENDERED))
    monkey.polygons[3].material_index = 1
    contents.append(textured_content_of(monkey, RENDERED))
    monkey.vertices[0].co.x += 0.1
    contents.append(textured_content_of(monkey, RENDERED))
    monkey.uv_layers["UVMap"].name = "renamed"
    contents.append(textured_content_of(monkey, RENDERED))
    contents.append(textured_content_of(monkey, MeshNeeds(("UVMap",), ("UVMap",))))
    assert len(set(contents)) == len(contents)


@pytest.mark.parametrize("kinds", [1, 2, 50])
def test_corners_share_a_vertex_where_position_and_normal_are_the_same(kinds: int) -> None:
    rng = np.random.default_rng(5)
    vertices = rng.integers(0, 40, 600, dtype=np.int32)
    normals = rng.integers(0, kinds, (600, 3), dtype=np.int32)
    kept, split = split_vertices(45, vertices, np.ascontiguousarray(normals.T))
    np.testing.assert_array_equal(vertices[kept][split], vertices)
    np.testing.assert_array_equal(normals[kept][split], normals)
    pairs = np.concatenate([vertices[:, None], normals], axis=1)
    assert len(kept) == len(np.unique(pairs, axis=0))
    assert split.dtype == np.int32

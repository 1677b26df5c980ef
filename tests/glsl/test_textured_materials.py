"""Pictures of textured materials against core/materials and core/kinds/kernel_pyramid at every sample."""

from dataclasses import replace

import bpy
import gpu
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.principled import Surface
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.errors import ShapeError
from rsibr.rsibr_addon.core.geometry.directions import transformed_normal
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.shading import principled_radiance
from rsibr.rsibr_addon.core.materials.normals import (
    SurfacePoints,
    bumped_normal,
    mapped_normal,
    shading_normal,
)
from rsibr.rsibr_addon.core.materials.packing import CHANNELS
from rsibr.rsibr_addon.core.materials.principled import (
    Baked,
    Bump,
    Input,
    Normal,
    NormalMap,
    Texture,
    constant,
)
from rsibr.rsibr_addon.core.materials.stand_ins import PLAIN
from rsibr.rsibr_addon.core.materials.surfaces import surface_at, value_at
from rsibr.rsibr_addon.device import buffers
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.drawing import Draw, GpuMesh
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.own_materials import MOST_TEXTURES, DrawnMaterial, OwnMaterials
from rsibr.rsibr_addon.device.textured_materials import textures_of
from rsibr.rsibr_addon.device.textured_mesh import GpuTexturedMesh
from rsibr.tests.glsl.principled_inputs import families, pyramid
from rsibr.tests.placed_drawing import depth_tested

SIZE = 64
SQUARE = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
UP = np.array([0.0, 0.0, 1.0])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
UV = 0.5 + 0.5 * SQUARE[:, None, :2]
FROM_ABOVE = Draw(
    np.eye(4), np.eye(4), np.diag([1.0, 1.0, -0.5, 1.0]), np.append(np.array([0.0, 0.6, 0.8]), 0.0)
)
"""Seen obliquely, but drawn straight from above: what a pixel shows is known exactly."""


def constants(*numbers: float) -> Input:
    return constant(numbers)


@pytest.fixture(scope="module")
def content() -> GpuPyramid:
    ensure_context()
    return GpuPyramid(pyramid(), families())


def texels(seed: int, height: int = 5, width: int = 7) -> np.ndarray:
    values = np.random.default_rng(seed).uniform(0.2, 0.9, (height, width, 4))
    return values.astype(np.float32).astype(np.float64)


def drawn(content: GpuPyramid, mesh: GpuMesh, look: object, draw: Draw = FROM_ABOVE) -> np.ndarray:
    """A picture, shape (SIZE, SIZE, 4)."""
    colour = buffers.render_target(SIZE)
    target = gpu.types.GPUFrameBuffer(color_slots=(colour,))
    with target.bind():
        target.clear(color=(0.0, 0.0, 0.0, 0.0))
        content.draw(mesh, draw, look)
        return buffers.pixels(target, SIZE)


def square(uv: np.ndarray = UV, slots: tuple[int, int] = (0, 0), **more: object) -> GpuTexturedMesh:
    more = {"uv_maps": ("UVMap",), **more}
    return GpuTexturedMesh(SQUARE, np.tile(UP, (4, 1)), TRIANGLES, np.array(slots), uv, **more)


def reference(
    surface: Surface,
    normal: np.ndarray = UP,
    view_dir: np.ndarray = FROM_ABOVE.eye[:3],
    smooth_normal: np.ndarray | None = None,
) -> np.ndarray:
    view_dir = np.broadcast_to(view_dir, (SIZE * SIZE, 3))
    normal = np.broadcast_to(normal, view_dir.shape)
    if smooth_normal is not None:
        smooth_normal = np.broadcast_to(smooth_normal, view_dir.shape)
    shown = principled_radiance(
        pyramid(), families(), surface, normal, view_dir, facet=smooth_normal, smooth_normal=smooth_normal
    )
    return shown.reshape(SIZE, SIZE, 3)


def assert_shows(picture: np.ndarray, surface: Surface) -> None:
    """Tolerance: that of test_principled_preview.py, and weights of texels have 8 bits."""
    expected = reference(surface)
    assert np.abs(picture[..., :3] - expected).max() < 4e-3 * expected.max()


PLACED = Texture("first", mapping=(1.7, -0.6, 0.3, 0.5, 2.1, -0.4))
OTHER = Texture("second", uv_map="other")
TEXTURED = replace(
    PLAIN,
    base_color=Input(((0.9, 0, 0, 0, 0), (0, 0, 0.7, 0, 0.1), (0, 0.5, 0, 0, 0)), PLACED),
    metallic=Input(((0, 0, 0, 1, -0.1),), PLACED),
    roughness=Input(((0, -0.8, 0, 0, 0.9),), OTHER),
    coat_weight=Input(((0.5, 0, 0.3, 0, 0),), OTHER),
    emission_color=Input(CHANNELS, OTHER),
    emission_strength=constants(0.05),
)


@pytest.mark.parametrize("extension", ["REPEAT", "EXTEND", "CLIP", "MIRROR"])
@pytest.mark.parametrize(
    ("closest", "covered"),
    [(False, (False, False)), (False, (True, True)), (True, (True, True)), (False, (True, False))],
)
def test_a_picture_is_what_the_reference_says(
    content: GpuPyramid, extension: str, closest: bool, covered: tuple[bool, bool]
) -> None:
    first, second = (
        replace(texture, extension=extension, closest=closest, covered=is_covered)
        for texture, is_covered in zip((PLACED, OTHER), covered, strict=True)
    )
    inputs = replace(
        TEXTURED,
        **{
            name: replace(value, texture=first if value.texture == PLACED else second)
            for name in ("base_color", "metallic", "roughness", "coat_weight", "emission_color")
            if (value := getattr(TEXTURED, name))
        },
    )
    of_first, of_second = texels(1), texels(2, 4, 6)
    images = {first: of_first, second: of_second}
    textures = {texture: buffers.texture(images[texture]) for texture in textures_of(inputs)}
    other_uv = UV[:, :1] @ [[0.3, 1.9], [-1.4, 0.2]] + [0.1, 0.7]
    mesh = square(np.concatenate([other_uv, UV], axis=1), uv_maps=("other", "UVMap"))
    picture = drawn(content, mesh, OwnMaterials((DrawnMaterial(inputs, textures),), antialiased=False))
    centres = texel_centres(SIZE, SIZE).reshape(-1, 2)
    uv = {"": centres @ [[0.3, 1.9], [-1.4, 0.2]] + [0.1, 0.7]}
    uv["other"] = uv[""]
    surface = surface_at(inputs, images, uv)
    expected = reference(surface)
    wrong = np.abs(picture[..., :3] - expected).max(axis=-1) > 4e-3 * expected.max()
    # What lies on an edge between texels may be on either side of it
    assert np.count_nonzero(wrong) <= (0.02 * SIZE**2 if closest or extension == "CLIP" else 0)


@pytest.mark.parametrize("texels_across", [1.6, 3.3])
def test_a_covered_image_without_holes_is_as_sharp_as_any(content: GpuPyramid, texels_across: float) -> None:
    """Tolerance: drivers approximate the logarithm that chooses mips."""
    image = bpy.data.images.new("Covered", 256, 256, alpha=True)
    values = np.dstack([texels(6, 256, 256)[..., :3], np.ones((256, 256))])
    image.pixels.foreach_set(values.astype(np.float32).ravel())
    scale = texels_across * SIZE / 256.0
    pictures = []
    for covered in (False, True):
        texture = Texture(image.name, mapping=(scale, 0.0, 0.1, 0.0, scale, 0.2), covered=covered)
        inputs = replace(PLAIN, base_color=Input(CHANNELS, texture), specular_level=constants(0.0))
        material = DrawnMaterial(inputs, {texture: gpu.texture.from_image(image)})
        pictures.append(drawn(content, square(), OwnMaterials((material,), antialiased=False)))
    bpy.data.images.remove(image)
    assert np.abs(pictures[1] - pictures[0]).max() < 0.03


HEIGHT = Texture("height", mapping=(1.3, 0.2, 0.1, -0.3, 0.9, 0.2))
MAP = Texture("normal", mapping=(0.8, -0.2, 0.1, 0.3, 0.7, 0.2), extension="MIRROR")
TANGENT = np.array([0.8, 0.6, 0.0, -1.0])
NORMAL_MAP = NormalMap(Input(CHANNELS, MAP), constants(0.7))
BUMP = Bump(Input(((0.2, 0.5, 0, 0, 0),), HEIGHT), constants(0.8), constants(0.3), invert=True)
TURN = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])


@pytest.mark.parametrize("normal", [NORMAL_MAP, BUMP, replace(BUMP, normal=NORMAL_MAP)])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("outside", [True, False])
def test_normals_are_what_the_reference_says(
    content: GpuPyramid, normal: Normal, turned: bool, outside: bool
) -> None:
    """Of an object that is turned and stretched, in a world that is turned; of either side."""
    up, triangles = (UP, TRIANGLES) if outside else (-UP, TRIANGLES[:, ::-1])
    model, turn = np.eye(4), np.eye(3)
    if turned:
        model[:3, :3] = [[2.0, -1.0, 0.0], [0.8, 1.6, 0.0], [0.3, 0.2, 1.0]]
        turn = TURN
    of_map, of_height = texels(4, 3, 4), texels(5)
    of_map[..., 2] = 0.9
    images = {MAP: of_map, HEIGHT: of_height}
    inputs = replace(PLAIN, normal=normal, metallic=constants(0.5), roughness=constants(0.6))
    textures = {texture: buffers.texture(values) for texture, values in images.items()}
    draw = replace(FROM_ABOVE, model=model, turn=turn)
    tangents = np.tile(TANGENT, (4, 1))
    mesh = GpuTexturedMesh(SQUARE, np.tile(up, (4, 1)), triangles, np.zeros(2, int), UV, tangents, ("UVMap",))
    picture = drawn(content, mesh, OwnMaterials((DrawnMaterial(inputs, textures),), antialiased=False), draw)

    to_object = np.linalg.inv(model[:2, :2])
    place = (2.0 * texel_centres(SIZE, SIZE).reshape(-1, 2) - 1.0) @ to_object.T
    steps = np.broadcast_to(2.0 / SIZE * to_object.T[:, None], (2, len(place), 2))
    points = SurfacePoints(
        np.broadcast_to(up, (len(place), 3)),
        np.broadcast_to(TANGENT, (len(place), 4)),
        {"": 0.5 + 0.5 * place},
        np.concatenate([steps, np.zeros((2, len(place), 1))], axis=-1) @ model[:3, :3].T,
        {"": 0.5 * steps},
    )
    below = normal if isinstance(normal, NormalMap) else normal.normal
    shown = transformed_normal(model[:3, :3], shading_normal(below, images, points))
    shown /= np.linalg.norm(shown, axis=-1, keepdims=True)
    if isinstance(normal, Bump):
        uv = [{"": points.uv[""] + 0.1 * step} for step in points.uv_steps[""]]
        here = value_at(normal.height, images, points.uv)
        rises = [-0.3 * (value_at(normal.height, images, moved) - here) / 0.1 for moved in uv]
        shown = bumped_normal(shown, points.position_steps, rises, np.full((len(place), 1), 0.8))
    own = transformed_normal(model[:3, :3], up)
    own /= np.linalg.norm(own)
    surface = Surface(metallic=0.5, roughness=0.6)
    expected = reference(surface, shown @ turn.T, turn @ draw.eye[:3], own @ turn.T)
    wrong = np.abs(picture[..., :3] - expected).max(axis=-1) > 0.01 * expected.max()
    # Where a tenth of a pixel crosses a line between texels, a bump's slope is another
    assert np.count_nonzero(wrong) <= (0.15 * SIZE**2 if isinstance(normal, Bump) else 0)


@pytest.mark.parametrize("coat", ["surface", "base", "own"])
def test_coats_have_their_own_normal(content: GpuPyramid, coat: str) -> None:
    image = np.broadcast_to([0.7, 0.4, 0.9, 1.0], (2, 2, 4))
    tilted = NormalMap(Input(CHANNELS, MAP), constants(1.0))
    own = NormalMap(constants(0.35, 0.5, 0.95), constants(1.0))
    coated = replace(PLAIN, coat_weight=constants(1.0), coat_roughness=constants(0.3), normal=tilted)
    coated = replace(coated, coat_normal={"surface": None, "base": tilted, "own": own}[coat])
    look = OwnMaterials((DrawnMaterial(coated, {MAP: buffers.texture(image)}),), antialiased=False)
    picture = drawn(content, square(tangents=np.tile(TANGENT, (4, 1))), look)
    base = mapped_normal(image[0, 0, :3], [1.0], UP, TANGENT)
    mapped = mapped_normal([0.35, 0.5, 0.95], [1.0], UP, TANGENT)
    over = {"surface": UP, "base": base, "own": mapped}[coat]
    points = (each[None] for each in (base, FROM_ABOVE.eye[:3], UP, over, UP))
    expected = principled_radiance(
        pyramid(), families(), Surface(coat_weight=1.0, coat_roughness=0.3), *points
    )
    np.testing.assert_allclose(picture[..., :3], np.broadcast_to(expected, (SIZE, SIZE, 3)), atol=2e-3)


def test_each_slot_has_its_own_material(content: GpuPyramid) -> None:
    metal = replace(PLAIN, metallic=constants(1.0))
    clay = replace(PLAIN, specular_level=constants(0.0), base_color=constants(0.5, 0.2, 0.1))
    both = drawn(content, square(slots=(1, 0)), OwnMaterials((DrawnMaterial(metal), DrawnMaterial(clay))))
    one, other = (drawn(content, square(), OwnMaterials((DrawnMaterial(each),))) for each in (metal, clay))
    column, row = np.meshgrid(np.arange(SIZE), np.arange(SIZE))
    assert np.array_equal(both[row > column], one[row > column])
    assert np.array_equal(both[row < column], other[row < column])
    # Slots beyond the last material have that one
    assert np.array_equal(drawn(content, square(slots=(3, 0)), OwnMaterials((DrawnMaterial(metal),))), one)
    # Drawn whole, as any mesh
    whole = drawn(content, square(slots=(1, 0)), Surface(metallic=1.0))
    np.testing.assert_allclose(whole, one, atol=1e-5 * one.max())


CHECKER = np.indices((4, 4)).sum(axis=0) % 2
HOLES = Texture("holes", closest=True)


def test_what_is_cut_out_hides_nothing(content: GpuPyramid) -> None:
    """A leaf of squares and holes, in front of a surface that is drawn later."""
    leaf = replace(PLAIN, alpha=Input(((0, 0, 0, 1, 0),), HOLES), base_color=constants(0.1, 0.6, 0.1))
    texture = buffers.texture(np.repeat(CHECKER[..., None], 4, axis=2))
    in_front, behind = (
        OwnMaterials((DrawnMaterial(leaf, {HOLES: texture}),)),
        OwnMaterials((DrawnMaterial(PLAIN),)),
    )
    nearer = np.eye(4)
    nearer[2, 3] = 0.5
    alone, ground = (drawn(content, square(), each) for each in (in_front, behind))
    with depth_tested(SIZE) as target:
        content.draw(square(), replace(FROM_ABOVE, model=nearer), in_front)
        content.draw(square(), FROM_ABOVE, behind)
        both = buffers.pixels(target, SIZE)
    covered = np.kron(CHECKER, np.ones((SIZE // 4, SIZE // 4))) > 0.0
    np.testing.assert_array_equal(alone[..., 3], covered)
    np.testing.assert_array_equal(both, np.where(covered[..., None], alone, ground))


def test_a_soft_edge_shows_what_lies_behind_it_in_the_same_mesh(content: GpuPyramid) -> None:
    """Of two layers the front one is drawn first, with alpha from 0 to 1; the other one is whole there."""
    ramp = np.repeat(np.linspace(0.0, 1.0, 5)[None, :, None], 4, axis=2)
    leaf = replace(PLAIN, alpha=Input(((0, 0, 0, 1, 0),), HOLES), metallic=Input(((0, 0, 0, 0, 1),), HOLES))
    material = DrawnMaterial(leaf, {HOLES: buffers.texture(ramp)})
    both = np.concatenate([SQUARE + [0.0, 0.0, 0.5], SQUARE])
    right_edge = np.full_like(UV, 0.99)
    mesh = GpuTexturedMesh(
        both,
        np.tile(UP, (8, 1)),
        np.concatenate([TRIANGLES, TRIANGLES + 4]),
        np.zeros(4, int),
        np.concatenate([UV, right_edge]),
        uv_maps=("UVMap",),
    )
    with depth_tested(SIZE) as target:
        content.draw(mesh, FROM_ABOVE, OwnMaterials((material,)))
        picture = buffers.pixels(target, SIZE)
    np.testing.assert_allclose(picture[..., 3], 1.0, atol=1e-6)
    np.testing.assert_allclose(picture[..., :3], reference(Surface(metallic=1.0)), atol=4e-3)


def test_what_covers_in_part_lies_over_what_is_there(content: GpuPyramid) -> None:
    pane = DrawnMaterial(replace(PLAIN, alpha=constants(0.25)))
    metal = DrawnMaterial(replace(PLAIN, metallic=constants(1.0)))
    alone, ground = (drawn(content, square(), OwnMaterials((each,))) for each in (pane, metal))
    # The first slot's triangle is drawn last, over the other's
    mesh = GpuTexturedMesh(
        SQUARE, np.tile(UP, (4, 1)), np.concatenate([TRIANGLES, TRIANGLES]), np.array([0, 0, 1, 1]), UV
    )
    picture = drawn(content, mesh, OwnMaterials((pane, metal)))
    np.testing.assert_allclose(alone[..., 3], 0.25)
    np.testing.assert_allclose(picture, alone + 0.75 * ground, atol=1e-5 * ground.max())
    assert gpu.state.blend_get() == "NONE"


def test_what_is_emitted_is_as_bright_in_a_world_of_any_strength(content: GpuPyramid) -> None:
    # Black but for what it emits
    glowing = replace(
        PLAIN,
        base_color=constants(0.0, 0.0, 0.0),
        specular_level=constants(0.0),
        emission_color=constants(0.5, 0.25, 1.0),
        emission_strength=constants(2.0),
    )
    look = OwnMaterials((DrawnMaterial(glowing),))
    for strength in (0.5, 1.0, 4.0):
        picture = strength * drawn(content, square(), look, replace(FROM_ABOVE, strength=strength))
        np.testing.assert_allclose(picture[..., :3], np.full((SIZE, SIZE, 3), (1.0, 0.5, 2.0)), 1e-3)


def test_a_uv_map_that_is_not_there_is_zero(content: GpuPyramid) -> None:
    image = texels(3)
    texture = Texture("first", uv_map="gone", extension="EXTEND")
    inputs = replace(PLAIN, base_color=Input(CHANNELS, texture))
    look = OwnMaterials((DrawnMaterial(inputs, {texture: buffers.texture(image)}),))
    assert_shows(drawn(content, square(), look), Surface(base_color=image[0, 0, :3]))


def test_what_cannot_be_drawn_is_told(content: GpuPyramid) -> None:
    many = [Texture(str(number)) for number in range(MOST_TEXTURES + 1)]
    fields = ("roughness", "metallic", "ior", "coat_weight", "coat_roughness", "coat_ior", "alpha")
    fields += ("specular_level", "diffuse_roughness")
    crowded = replace(
        PLAIN, **{name: Input(CHANNELS[:1], texture) for name, texture in zip(fields, many, strict=True)}
    )
    with pytest.raises(ShapeError, match="9 textures, and previews take 8"):
        drawn(content, square(), OwnMaterials((DrawnMaterial(crowded),)))
    baked = replace(PLAIN, roughness=Baked("Noise Texture"))
    with pytest.raises(ShapeError, match=r"still to be baked \(Noise Texture\)"):
        drawn(content, square(), OwnMaterials((DrawnMaterial(baked),)))
    mesh = GpuMesh(SQUARE, np.tile(UP, (4, 1)), TRIANGLES)
    with pytest.raises(ShapeError, match="without material slots"):
        drawn(content, mesh, OwnMaterials((DrawnMaterial(PLAIN),)))

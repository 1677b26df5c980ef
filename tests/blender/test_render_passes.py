"""What renders leave out and tell apart, as Cycles does: holdouts, normals of materials, emission."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.host.render_views import NOTHING
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.reflection_tables import ReflectionTablesSettings
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.tests.blender.conftest import Render

pytestmark = [pytest.mark.needs("gl", "cycles"), pytest.mark.usefixtures("registered")]


def by_object(scene: bpy.types.Scene) -> None:
    bpy.data.objects["Cube"].is_holdout = True


def by_collection(scene: bpy.types.Scene) -> None:
    collection = bpy.data.collections.new("Holdouts")
    scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects["Cube"])
    bpy.data.collections["Collection"].objects.unlink(bpy.data.objects["Cube"])
    bpy.context.view_layer.layer_collection.children["Holdouts"].holdout = True


@pytest.mark.slow
@pytest.mark.parametrize(("hold_out", "film_transparent"), [(by_object, False), (by_collection, True)])
def test_holdouts_make_the_holes_that_cycles_makes(
    scene: bpy.types.Scene,
    render: Render,
    hold_out: Callable[[bpy.types.Scene], None],
    film_transparent: bool,
) -> None:
    """One object in front of the hole, one behind it."""
    for place, size in (((2.0, -1.5, 0.6), 0.5), ((-2.0, 2.0, 0.0), 1.8)):
        other = bpy.data.objects.new("Other", bpy.data.objects["Cube"].data.copy())
        other.location, other.scale = place, (size,) * 3
        bpy.data.collections["Collection"].objects.link(other)
    hold_out(scene)
    scene.render.film_transparent = film_transparent
    ours, truth = render(samples=16), render("CYCLES", samples=16)
    holes = truth["Combined"][..., 3] == 0.0
    if not film_transparent:
        assert holes.sum() > 100
        assert (ours["Combined"][holes] == 0.0).mean() > 0.9  # but for their edges
    assert (truth["Depth"] < NOTHING).sum() > 100
    np.testing.assert_array_equal(ours["Depth"] < NOTHING, truth["Depth"] < NOTHING)
    apart = np.abs(ours["Combined"][..., 3] - truth["Combined"][..., 3])
    assert apart.max() < 3.0 * 0.5 / np.sqrt(16)  # of a share that 16 random samples tell, at most


def add_image(folder: Path, name: str, texels: np.ndarray) -> bpy.types.Image:
    image = bpy.data.images.new(name, texels.shape[1], texels.shape[0], float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(texels.astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(folder / f"{name}.exr"), "OPEN_EXR"
    image.save()
    return image


def normal_mapped(folder: Path, node: bpy.types.Node) -> None:
    tree = node.id_data
    rows, columns = np.mgrid[:16, :16]
    normal = np.stack([0.5 * np.sin(columns / 4.0), 0.3 * np.cos(rows / 3.0), np.ones((16, 16))], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    texels = np.concatenate([0.5 + 0.5 * normal, np.ones((16, 16, 1))], axis=-1)
    texture, mapped = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
    texture.image = add_image(folder, "normals", texels)
    tree.links.new(texture.outputs["Color"], mapped.inputs["Color"])
    tree.links.new(mapped.outputs["Normal"], node.inputs["Normal"])


def bumped(folder: Path, node: bpy.types.Node) -> None:
    tree = node.id_data
    rows, columns = np.mgrid[:16, :16]
    height = 0.5 + 0.5 * np.sin(columns / 2.5) * np.cos(rows / 2.5)
    texels = np.stack([height, height, height, np.ones_like(height)], axis=-1)
    texture, bump = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeBump")
    texture.image = add_image(folder, "height", texels)
    bump.inputs["Distance"].default_value = 0.3
    tree.links.new(texture.outputs["Color"], bump.inputs["Height"])
    tree.links.new(bump.outputs["Normal"], node.inputs["Normal"])


@pytest.mark.slow
@pytest.mark.parametrize("change", [normal_mapped, bumped])
def test_normals_are_those_that_materials_are_shaded_with(
    scene: bpy.types.Scene,
    render: Render,
    tmp_path: Path,
    change: Callable[[Path, bpy.types.Node], None],
) -> None:
    node = bpy.data.materials["Material"].node_tree.nodes["Principled BSDF"]
    node.inputs["Specular IOR Level"].default_value = 0.0  # Cycles turns normals of mirrors to the eye
    scene.render.film_transparent = True
    plain = render()["Normal"]
    change(tmp_path, node)
    ours, truth = render(samples=64), render("CYCLES", samples=64)
    inside = (ours["Combined"][..., 3] == 1.0) & (truth["Combined"][..., 3] == 1.0)
    assert inside.sum() > 300
    assert np.median(np.abs(ours["Normal"] - plain)[inside]) > 0.02
    apart = np.linalg.norm(ours["Normal"] - truth["Normal"], axis=-1)[inside]
    # Within a pixel, normals differ by some tenths, and each engine takes the mean of 64 of them
    assert np.median(apart) < 0.02


def composited(scene: bpy.types.Scene, swapped_in: bpy.types.Scene) -> None:
    """Have a scene's pictures be alpha and depth of two scenes', by whichever is nearer."""
    tree = bpy.data.node_groups.new("Swap", "CompositorNodeTree")
    scene.compositing_node_group = tree
    tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
    nearer, parted, joined = (
        tree.nodes.new(f"CompositorNode{name}") for name in ("Zcombine", "SeparateColor", "CombineColor")
    )
    for each, name in ((scene, "A"), (swapped_in, "B")):
        layers = tree.nodes.new("CompositorNodeRLayers")
        layers.scene = each
        tree.links.new(layers.outputs["Image"], nearer.inputs[name])
        tree.links.new(layers.outputs["Depth"], nearer.inputs[f"Depth {name}"])
    tree.links.new(nearer.outputs["Result"], parted.inputs["Image"])
    tree.links.new(parted.outputs["Alpha"], joined.inputs["Red"])
    tree.links.new(nearer.outputs["Depth"], joined.inputs["Green"])
    tree.links.new(joined.outputs["Image"], tree.nodes.new("NodeGroupOutput").inputs[0])


@pytest.mark.slow
def test_what_a_compositor_swaps_in_lies_where_cycles_has_it(
    scene: bpy.types.Scene,
    render: Render,
    tmp_path: Path,
) -> None:
    """A cube by RSIBR in a picture by Cycles, whose own engine needs no world to be baked."""
    scene.render.film_transparent = True
    other = bpy.data.objects.new("Other", bpy.data.objects["Cube"].data.copy())
    other.location, other.rotation_euler = (-0.6, 0.4, 0.5), (0.3, 0.5, 0.0)
    scene.collection.objects.link(other)
    truth = render("CYCLES", samples=64)
    ours = bpy.data.scenes.new("ours")
    ours.render.engine, ours.world, ours.camera = "RSIBR", scene.world, scene.camera
    ours.render.film_transparent, ours.rsibr_render.samples = True, 64
    ours.rsibr_bake.kernel_pyramid.size = "256"
    ours.view_layers[0].use_pass_z = True
    ours.collection.objects.link(bpy.data.objects["Cube"])
    bpy.data.collections["Collection"].objects.unlink(bpy.data.objects["Cube"])
    composited(scene, ours)
    settings = scene.render.image_settings
    settings.media_type, settings.file_format, settings.color_depth = "IMAGE", "OPEN_EXR", "32"
    scene.render.filepath = str(tmp_path / "swapped.exr")
    bpy.ops.render.render(write_still=True)
    alpha, depth, _ = np.moveaxis(read_exr(tmp_path / "swapped.exr")[..., :3], -1, 0)
    there = truth["Depth"][..., 0] < NOTHING
    np.testing.assert_array_equal(depth < NOTHING, there)
    assert 300 < there.sum() < there.size / 2
    # See test_render_engine for both
    np.testing.assert_allclose(depth[there], truth["Depth"][there, 0], atol=5e-4)
    apart = np.abs(alpha - truth["Combined"][..., 3])
    # Z Combine takes one picture's pixel where both cover it in part, as at a silhouette before the other
    assert np.quantile(apart, 0.98) < 3.0 * 0.5 / np.sqrt(64)
    assert apart.mean() < 0.01


def test_emission_of_reflection_tables_is_told_apart(
    scene: bpy.types.Scene,
    render: Render,
    tmp_path: Path,
) -> None:
    cube = bpy.data.objects["Cube"]
    cube.rsibr.map_set = str(tmp_path / "glowing.rsibr.exr")
    settings = ReflectionTablesSettings(
        diffuse="lambert:kd=0.5", emission="0.4/0.2/0.1", specular="mirror:", weights="constant:k=0.25"
    )
    drain(bake(BakeJob(settings, cube.rsibr.map_set, Light(environment="forest"))))
    scene.render.film_transparent = True
    passes = render()
    covered = passes["Combined"][..., 3] == 1.0
    seen = passes["Emission"][covered]
    # A quarter of light goes to the mirror, and the rest to the diffuse table, which emits
    np.testing.assert_allclose(seen, np.broadcast_to([0.3, 0.15, 0.075], seen.shape), rtol=1e-5)
    assert (passes["Combined"][covered, :3] > seen).all()
    assert not passes["Emission"][~covered].any()

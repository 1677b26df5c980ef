"""Materials: found by name, told apart by content, refused in words."""

from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.cycles_presets import PRESETS
from rsibr.rsibr_addon.core.errors import InputFileError, SceneError
from rsibr.rsibr_addon.host import materials
from rsibr.rsibr_addon.host.materials import fingerprint, lasting_spec, load_material, material_name
from rsibr.rsibr_addon.host.shape_dependence import shape_dependence


@pytest.fixture
def material() -> bpy.types.Material:
    """A material with a group, a ramp, a curve and an image."""
    material = bpy.data.materials.new("mixed")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    bsdf = nodes["Principled BSDF"]
    ramp = nodes.new("ShaderNodeValToRGB")
    curve = nodes.new("ShaderNodeRGBCurve")
    picture = nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.new("picture", 4, 2)
    tree = bpy.data.node_groups.new("group", "ShaderNodeTree")
    tree.interface.new_socket("Plain", in_out="OUTPUT", socket_type="NodeSocketFloat")
    tree.interface.new_socket("Placed", in_out="OUTPUT", socket_type="NodeSocketVector")
    end = tree.nodes.new("NodeGroupOutput")
    value = tree.nodes.new("ShaderNodeValue")
    place = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(value.outputs[0], end.inputs["Plain"])
    tree.links.new(place.outputs["Position"], end.inputs["Placed"])
    group = nodes.new("ShaderNodeGroup")
    group.node_tree = tree
    links.new(group.outputs["Plain"], ramp.inputs[0])
    links.new(ramp.outputs["Color"], curve.inputs["Color"])
    links.new(curve.outputs["Color"], bsdf.inputs["Base Color"])
    return material


def saved(path: Path, *names: str) -> Path:
    """Write a file with materials of these names."""
    materials = set()
    for name in names:
        material = bpy.data.materials.new(name)
        material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.25
        materials.add(material)
    bpy.data.libraries.write(str(path), materials)
    for material in materials:
        bpy.data.materials.remove(material)
    return path


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_fits_a_radiance_map(name: str) -> None:
    material = load_material(name)
    assert shape_dependence(material) == []
    bsdf = next(node for node in material.node_tree.nodes if node.bl_idname == PRESETS[name].node)
    for key, value in PRESETS[name].inputs.items():
        np.testing.assert_allclose(np.array(bsdf.inputs[key].default_value), value, rtol=1e-6)  # float32


def test_presets_differ() -> None:
    assert len({fingerprint(load_material(name)) for name in PRESETS}) == len(PRESETS)


@pytest.mark.parametrize("name", ["red", "red:dark", "a.blend:b"])
def test_a_material_comes_from_a_file(tmp_path: Path, name: str) -> None:
    path = saved(tmp_path / "materials.blend", name, "other")
    material = load_material(f"{path}:{name}")
    assert material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value == 0.25
    assert material_name(f"{path}:{name}") == name


def test_a_drive_letter_is_part_of_the_path() -> None:
    assert material_name(r"C:\materials.blend:red") == "red"


def test_a_material_of_the_open_file_needs_no_file(tmp_path: Path) -> None:
    assert load_material(":Material") == bpy.data.materials["Material"]
    assert lasting_spec(":Material") == ":Material"
    path = tmp_path / "open.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    assert load_material(f"{path}:Material") == bpy.data.materials["Material"]
    assert lasting_spec(":Material") == f"{path}:Material"
    assert lasting_spec("copper") == "copper"


def test_what_cannot_be_loaded_is_said(tmp_path: Path) -> None:
    library = saved(tmp_path / "many.blend", *(f"m{i}" for i in range(9)))
    text, cut = tmp_path / "text.blend", tmp_path / "cut.blend"
    text.write_text("no file of Blender's")
    cut.write_bytes(library.read_bytes()[:3000])
    for spec, error, words in [
        ("coper", InputFileError, "There is no material coper (did you mean copper?): name one of"),
        (f"{tmp_path}:red", InputFileError, "FILE.blend:NAME"),
        (f"{tmp_path}/no.blend:red", InputFileError, f"There is no file {tmp_path}/no.blend"),
        (f"{text}:red", InputFileError, f"{text} is no file that Blender"),
        (f"{cut}:red", InputFileError, f"{cut} is no file that Blender"),
        (
            f"{library}:red",
            SceneError,
            "no material red: choose one of m0, m1, m2, m3, m4, m5, m6, m7 and 1",
        ),
        (":red", SceneError, "This file holds no material red"),
    ]:
        with pytest.raises(error) as caught:
            load_material(spec)
        assert words in str(caught.value)


def test_a_material_without_a_surface_is_refused() -> None:
    material = bpy.data.materials["Material"]
    output = material.node_tree.nodes["Material Output"]
    material.node_tree.links.remove(output.inputs["Surface"].links[0])
    with pytest.raises(SceneError, match="Material Material has no surface: link a shader"):
        load_material(":Material")
    material.node_tree.nodes.remove(output)
    with pytest.raises(SceneError, match="has no surface"):
        load_material(":Material")


CHANGES: dict[str, Callable[[bpy.types.Material], None]] = {
    "a value": lambda m: setattr(
        m.node_tree.nodes["Principled BSDF"].inputs["Roughness"], "default_value", 0.4321
    ),
    "an option": lambda m: setattr(m.node_tree.nodes["Principled BSDF"], "distribution", "GGX"),
    "a ramp": lambda m: setattr(
        m.node_tree.nodes["Color Ramp"].color_ramp.elements[1], "color", (1, 0, 0, 1)
    ),
    "a curve": lambda m: setattr(
        m.node_tree.nodes["RGB Curves"].mapping.curves[0].points[0], "location", (0, 0.5)
    ),
    "a value in a group": lambda m: setattr(
        bpy.data.node_groups["group"].nodes["Value"].outputs[0], "default_value", 0.5
    ),
    "another link": lambda m: m.node_tree.links.new(
        m.node_tree.nodes["Image Texture"].outputs["Color"],
        m.node_tree.nodes["Principled BSDF"].inputs["Base Color"],
    ),
    "pixels": lambda m: bpy.data.images["picture"].pixels.__setitem__(0, 0.5),
    "what is generated": lambda m: setattr(bpy.data.images["picture"], "generated_type", "UV_GRID"),
    "a colour space": lambda m: setattr(bpy.data.images["picture"].colorspace_settings, "name", "Non-Color"),
    "a muted node": lambda m: setattr(m.node_tree.nodes["RGB Curves"], "mute", True),
}


@pytest.mark.parametrize("change", CHANGES)
def test_a_fingerprint_changes_with(change: str, material: bpy.types.Material) -> None:
    before = fingerprint(material)
    CHANGES[change](material)
    assert fingerprint(material) != before


def test_a_fingerprint_does_not_change_with_names_and_layout(material: bpy.types.Material) -> None:
    before = fingerprint(material)
    assert fingerprint(material.copy()) == before
    material.name = "other"
    for node in material.node_tree.nodes:
        node.location, node.select, node.width, node.label = (3, 4), True, 222, "label"
    material.node_tree.nodes.new("NodeFrame")
    bpy.data.node_groups["group"].name = "renamed"
    assert fingerprint(material) == before


def test_a_fingerprint_survives_saving_and_loading(material: bpy.types.Material, tmp_path: Path) -> None:
    before = fingerprint(material)
    path = tmp_path / "materials.blend"
    bpy.data.libraries.write(str(path), {material})
    assert fingerprint(load_material(f"{path}:mixed")) == before


def test_an_image_file_counts_by_content(material: bpy.types.Material, tmp_path: Path) -> None:
    image = bpy.data.images["picture"]
    for name in ("a.png", "b.png", "c.png"):
        if name == "c.png":
            image.pixels[0] = 0.5
        image.save(filepath=str(tmp_path / name))
    prints = []
    for name in ("a.png", "b.png", "c.png"):
        material.node_tree.nodes["Image Texture"].image = bpy.data.images.load(str(tmp_path / name))
        prints.append(fingerprint(material))
    assert prints[0] == prints[1] != prints[2]


def test_pixels_count_where_an_image_is_packed_and_painted(material: bpy.types.Material) -> None:
    image = bpy.data.images["picture"]
    image.pack()
    packed = fingerprint(material)
    assert fingerprint(material) == packed
    image.pixels[0] = 0.5
    painted = fingerprint(material)
    image.pixels[0] = 0.7
    assert len({packed, painted, fingerprint(material)}) == 3


def test_every_tile_of_an_image_counts(material: bpy.types.Material, tmp_path: Path) -> None:
    painted = bpy.data.images.new("tile", 4, 4)
    tiled = bpy.data.images.new("tiled", 4, 4, tiled=True)
    for number in (1001, 1002):
        painted.save(filepath=str(tmp_path / f"{number}.png"))
    tiled.filepath = str(tmp_path / "<UDIM>.png")
    tiled.tiles.new(1002)
    tiled.reload()
    material.node_tree.nodes["Image Texture"].image = tiled
    before = fingerprint(material)
    painted.pixels[0] = 0.5
    painted.save(filepath=str(tmp_path / "1002.png"))
    assert fingerprint(material) != before


def test_pixels_are_read_of_nothing_but_what_is_painted(
    material: bpy.types.Material, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(materials, "_pixels_digest", lambda image: pytest.fail(f"{image.name} is read"))
    image = bpy.data.images["picture"]
    fingerprint(material)
    image.filepath_raw, image.file_format = str(tmp_path / "picture.png"), "PNG"
    image.save()
    fingerprint(material)
    image.pack()
    assert image.packed_files
    fingerprint(material)


def linked(material: bpy.types.Material, kind: str, output: str | int, target: str = "Base Color") -> None:
    """Add a node and link it to the material's BSDF."""
    node = material.node_tree.nodes.new(kind)
    bsdf = material.node_tree.nodes["Principled BSDF"]
    material.node_tree.links.new(node.outputs[output], bsdf.inputs[target])


def behind(material: bpy.types.Material, kind: str) -> None:
    """Have a shader node instead of the BSDF, but for a half."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mix = nodes.new("ShaderNodeMixShader")
    links.new(nodes["Principled BSDF"].outputs[0], mix.inputs[1])
    links.new(nodes.new(kind).outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], nodes["Material Output"].inputs["Surface"])


def valued(material: bpy.types.Material, name: str, value: float) -> None:
    material.node_tree.nodes["Principled BSDF"].inputs[name].default_value = value


DEPENDENT: dict[str, Callable[[bpy.types.Material], None]] = {
    "(Position)": lambda m: linked(m, "ShaderNodeNewGeometry", "Position"),
    "(Generated)": lambda m: linked(m, "ShaderNodeTexCoord", "Generated"),
    "(Object)": lambda m: linked(m, "ShaderNodeTexCoord", "Object"),
    "(UV)": lambda m: linked(m, "ShaderNodeTexCoord", "UV"),
    "(Window)": lambda m: linked(m, "ShaderNodeTexCoord", "Window"),
    "default coordinates": lambda m: linked(m, "ShaderNodeTexNoise", 0),
    "an attribute": lambda m: linked(m, "ShaderNodeAttribute", 0),
    "on the object": lambda m: linked(m, "ShaderNodeObjectInfo", "Random"),
    "distance to the camera": lambda m: linked(m, "ShaderNodeCameraData", 1, "Roughness"),
    "the tangent": lambda m: linked(m, "ShaderNodeNormalMap", 0, "Normal"),
    "anisotropy": lambda m: valued(m, "Anisotropic", 0.1),
    "light passes": lambda m: valued(m, "Transmission Weight", 0.5),
    "passes through": lambda m: valued(m, "Alpha", 0.5),
    "passes through the object": lambda m: behind(m, "ShaderNodeBsdfTransparent"),
    "through the object": lambda m: behind(m, "ShaderNodeSubsurfaceScattering"),
}


@pytest.mark.parametrize("words", DEPENDENT)
def test_dependence_on_shape_is_found(words: str) -> None:
    material = bpy.data.materials["Material"]
    DEPENDENT[words](material)
    (reason,) = shape_dependence(material)
    assert words in reason
    assert "(node " in reason


def test_displacement_and_volume_are_found() -> None:
    material = bpy.data.materials["Material"]
    nodes, links = material.node_tree.nodes, material.node_tree.links
    output = nodes["Material Output"]
    links.new(nodes.new("ShaderNodeDisplacement").outputs[0], output.inputs["Displacement"])
    links.new(nodes.new("ShaderNodeVolumeScatter").outputs[0], output.inputs["Volume"])
    assert shape_dependence(material) == ["it has a volume", "it has a displacement"]


INDEPENDENT: dict[str, Callable[[bpy.types.Material], None]] = {
    "normal": lambda m: linked(m, "ShaderNodeNewGeometry", "Normal"),
    "incoming": lambda m: linked(m, "ShaderNodeNewGeometry", "Incoming"),
    "reflection": lambda m: linked(m, "ShaderNodeTexCoord", "Reflection"),
    "facing": lambda m: linked(m, "ShaderNodeLayerWeight", "Facing", "Roughness"),
    "emission": lambda m: behind(m, "ShaderNodeEmission"),
    "anisotropic node without anisotropy": lambda m: behind(m, "ShaderNodeBsdfAnisotropic"),
    "an unlinked node": lambda m: m.node_tree.nodes.new("ShaderNodeTexNoise"),
}


@pytest.mark.parametrize("what", INDEPENDENT)
def test_what_a_radiance_map_can_hold_is_let_pass(what: str) -> None:
    material = bpy.data.materials["Material"]
    INDEPENDENT[what](material)
    assert shape_dependence(material) == []


def test_only_the_outputs_used_of_a_group_count(material: bpy.types.Material) -> None:
    assert shape_dependence(material) == []
    nodes, links = material.node_tree.nodes, material.node_tree.links
    links.new(nodes["Group"].outputs["Placed"], nodes["Principled BSDF"].inputs["Coat Normal"])
    assert shape_dependence(material) == ["it depends on the place on the surface (Position) (node Geometry)"]


def test_a_chain_of_any_length_is_followed(material: bpy.types.Material) -> None:
    tree = material.node_tree
    before = tree.nodes.new("ShaderNodeObjectInfo").outputs["Random"]
    for _ in range(1000):
        node = tree.nodes.new("ShaderNodeMath")
        tree.links.new(before, node.inputs[0])
        before = node.outputs[0]
    output = tree.get_output_node("ALL")
    emission = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(before, emission.inputs["Strength"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    assert shape_dependence(material) == ["it depends on the object (node Object Info)"]

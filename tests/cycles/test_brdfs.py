"""Materials measured into reflectance models, from their text."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf import measured_material
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo as table_albedo
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.spec import spec_from_brdf
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning, SceneError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.host.furnace import COSINES, directional_albedo
from rsibr.rsibr_addon.host.materials import load_material
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.tasks.reflectance.brdfs import load_brdf

pytestmark = pytest.mark.needs("cycles")


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tables of few cells: enough for what is smooth."""
    monkeypatch.setattr(measured_material, "DEFAULT_SHAPE", (12, 8, 8))


@pytest.mark.slow
def test_a_coated_plastic_sends_back_what_it_does_in_a_furnace() -> None:
    brdf = drain(load_brdf("blend:plastic"))
    shown = [3, 7, 15, 31, 63]
    with temporary_scene() as scene:
        expected = directional_albedo(scene, load_material("plastic"), seed=1)[:, shown]
    cosine = (np.array(shown) + 0.5) / COSINES
    coat = table_albedo(brdf.glossy, cosine)
    # Of a million samples the furnace knows 0.3 %, several times that where few of them take a part.
    np.testing.assert_allclose(coat, expected[1], rtol=0.02)
    np.testing.assert_allclose(table_albedo(brdf.diffuse, cosine), expected[0], rtol=0.02)
    assert brdf.layers == (brdf.diffuse, brdf.glossy)
    assert spec_from_brdf(brdf) == "blend:plastic"


@pytest.mark.usefixtures("coarse")
def test_between_steps_nothing_of_ours_is_in_the_file() -> None:
    before = {repr(item) for item in bpy.data.all_ids}
    for number, step in enumerate(load_brdf(" blend : clay ")):
        assert (step.done, step.total) == (number, 8)
        assert {repr(item) for item in bpy.data.all_ids} == before
    assert number == 7


@pytest.mark.usefixtures("coarse")
def test_a_material_of_the_open_file_is_measured_and_not_touched() -> None:
    material = bpy.data.materials.new("Paint: red")
    (node,) = (node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    node.inputs["Base Color"].default_value = (0.5, 0.1, 0.1, 1.0)
    node.inputs["Specular IOR Level"].default_value = 0.0
    node.inputs["Emission Strength"].default_value = 0.0
    before = {repr(item) for item in bpy.data.all_ids}
    brdf = drain(load_brdf("blend::Paint: red"))
    assert {repr(item) for item in bpy.data.all_ids} == before
    found = brdf((0.0, 0.0, 1.0), (0.3, 0.0, np.sqrt(0.91)))
    np.testing.assert_allclose(found, np.array([0.5, 0.1, 0.1]) / np.pi, rtol=1e-3)
    assert material.cycles.emission_sampling == "AUTO"


def test_other_texts_are_models_as_ever() -> None:
    assert drain(load_brdf("lambert:kd=0.5")) == Lambert(kd=0.5)


@pytest.mark.usefixtures("coarse")
def test_what_cannot_be_measured_is_named() -> None:
    with pytest.raises(
        InputFileError, match=r"There is no material nothing: name one of .*FILE\.blend:NAME\."
    ):
        drain(load_brdf("blend:nothing"))
    with pytest.raises(
        SceneError, match=r"Material mirror only mirrors, .*: give it a roughness of 0.1 or more"
    ):
        drain(load_brdf("blend:mirror"))


@pytest.mark.usefixtures("coarse")
def test_what_a_table_does_not_hold_is_told() -> None:
    material = bpy.data.materials.new("lamp")
    (node,) = (node for node in material.node_tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")
    node.inputs["Roughness"].default_value = 1.0
    node.inputs["Emission Strength"].default_value = 2.0
    checker = material.node_tree.nodes.new("ShaderNodeTexChecker")
    material.node_tree.links.new(checker.outputs["Color"], node.inputs["Base Color"])
    with pytest.warns(RsibrWarning) as told:
        drain(load_brdf("blend::lamp"))
    by_place, less = (str(warning.message) for warning in told)
    assert by_place.startswith(
        "No BRDF can hold :lamp, so it is measured as it looks on a small flat tile: its"
    )
    assert "The measured reflectance of :lamp sends back " in less
    assert "% less light than the material" in less

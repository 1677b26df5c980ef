"""What objects say of their previews, and the looks that tasks make of it."""

from dataclasses import fields
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import Role
from rsibr.rsibr_addon.files.kinds.registry import look_types
from rsibr.rsibr_addon.host import visible_surfaces
from rsibr.rsibr_addon.host.option_properties import options_of, replaced_options
from rsibr.rsibr_addon.host.visible_surfaces import is_wanted, map_set_of, surfaces
from rsibr.rsibr_addon.host.world_light import WorldLight, follows_world, world_light
from rsibr.rsibr_addon.settings.lobe_stack import LobeStackSettings
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.viewport.contents import Contents
from rsibr.rsibr_addon.tasks.viewport.faults import settings_of

pytestmark = pytest.mark.usefixtures("registered")


@pytest.mark.parametrize("kind", look_types())
def test_an_untouched_object_is_shaded_by_its_kind_s_defaults(kind: str) -> None:
    cube = bpy.data.objects["Cube"]
    look, default = options_of(look_types()[kind], getattr(cube.rsibr, kind)), look_types()[kind]()
    for field in fields(default):
        found, expected = getattr(look, field.name), getattr(default, field.name)
        if isinstance(expected, tuple) and expected and isinstance(expected[0], float):
            assert found == pytest.approx(expected)  # properties are single precision
        elif isinstance(expected, tuple):
            assert set(found) == set(expected)
        else:
            assert found == expected


def test_settings_reach_the_look_and_are_told_apart() -> None:
    cube = bpy.data.objects["Cube"]
    before = settings_of(cube)
    assert settings_of(cube) == before
    cube.rsibr.mip_chain.k_d = (0.25, 0.5, 1.0)  # as files of version 0.1 hold it
    assert options_of(MipLook, cube.rsibr.mip_chain).kd == (0.25, 0.5, 1.0)
    assert settings_of(cube) != before
    assert options_of(MipLook, cube.rsibr.mip_chain).roughness is None
    cube.rsibr.mip_chain.use_roughness = True
    assert options_of(MipLook, cube.rsibr.mip_chain).roughness == pytest.approx(0.3)
    # What is replaced keeps its value, and counts for nothing meanwhile
    chain = cube.rsibr.mip_chain
    chain.bias = 2.5
    assert replaced_options(MipLook, chain) == {"mip"}
    assert options_of(MipLook, chain) == MipLook(roughness=0.3, kd=(0.25, 0.5, 1.0))
    chain.use_exponent, chain.exponent = True, 40.0
    assert replaced_options(MipLook, chain) == {"mip", "roughness"}
    assert options_of(MipLook, chain) == MipLook(exponent=40.0, kd=(0.25, 0.5, 1.0))
    chain.use_roughness = chain.use_exponent = False
    assert options_of(MipLook, chain).mip == 2.5
    cube.rsibr.reflection_tables.shown = {"retro"}
    assert options_of(TablesLook, cube.rsibr.reflection_tables).shown == (Role.RETRO,)


def test_nothing_is_wanted_until_a_file_is_named_and_shown() -> None:
    cube = bpy.data.objects["Cube"]
    assert not is_wanted()
    cube.rsibr.map_set = "/tmp/some.rsibr.exr"
    assert is_wanted()
    assert map_set_of(cube) == "/tmp/some.rsibr.exr"
    cube.rsibr.show = False
    assert not is_wanted()
    assert map_set_of(cube) == ""


def test_surfaces_are_those_that_blender_shows() -> None:
    cube = bpy.data.objects["Cube"]
    cube.location = (1.0, 2.0, 3.0)
    wired = bpy.data.objects.new("Wired", cube.data.copy())
    wired.display_type = "WIRE"
    hidden = bpy.data.objects.new("Hidden", cube.data)
    text = bpy.data.objects.new("Text", bpy.data.curves.new("Text", "FONT"))
    text.data.body = "A"
    grouped = bpy.data.collections.new("Grouped")
    inner = bpy.data.objects.new("Inner", cube.data)
    grouped.objects.link(inner)
    instancer = bpy.data.objects.new("Instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", grouped
    instancer.location = (0.0, 0.0, 7.0)
    for item in (wired, hidden, text, instancer):
        bpy.context.collection.objects.link(item)
    hidden.hide_set(True)
    found = [surface for surface, _ in surfaces(bpy.context.evaluated_depsgraph_get())]
    assert {surface.item.name for surface in found} == {"Cube", "Text", "Inner"}
    by_name = {surface.item.name: surface for surface in found}
    assert by_name["Inner"].shown_by == instancer
    np.testing.assert_array_equal(by_name["Inner"].matrix[:3, 3], (0.0, 0.0, 7.0))
    np.testing.assert_array_equal(by_name["Cube"].matrix[:3, 3], (1.0, 2.0, 3.0))
    assert by_name["Inner"].mesh == by_name["Cube"].mesh  # one mesh, uploaded once


def test_a_mesh_has_a_new_number_when_it_changes_and_no_other_time() -> None:
    cube = bpy.data.objects["Cube"]

    def number() -> int:
        ((surface, _),) = surfaces(bpy.context.evaluated_depsgraph_get())
        return surface.mesh

    seen = [number()]
    cube.location.x = 3.0
    assert number() == seen[-1]
    changes = [
        lambda: cube.data.update(),
        lambda: cube.modifiers.new("Subdivision", "SUBSURF"),
        lambda: cube.data.shade_smooth(),
        lambda: cube.modifiers.clear(),
    ]
    for change in changes:
        change()
        assert number() not in seen
        seen.append(number())


def test_a_single_lobe_is_a_number_as_files_of_version_0_1_hold_it() -> None:
    group = bpy.data.objects["Cube"].rsibr.lobe_stack
    assert options_of(StackLook, group).lobes == ()
    group.use_lobes = True
    group.bl_system_properties_get(do_create=True)["lobes"] = 5
    assert options_of(StackLook, group).lobes == (5,)


def test_a_fit_spares_what_fits_are_told(tmp_path: Path) -> None:
    group = bpy.context.scene.rsibr_bake.lobe_stack
    fit = tmp_path / "fit.json"
    group.source, group.fit, group.lobes, group.brdf = "FIT", str(fit), 5, "lambert:kd=1"
    with pytest.raises(InputFileError, match=r"There is no file .*fit\.json: choose another"):
        options_of(LobeStackSettings, group)
    fit.touch()
    settings = options_of(LobeStackSettings, group)
    assert (settings.brdf, settings.fit, settings.lobes) == (None, str(fit), 3)


def test_an_object_follows_the_world_unless_that_was_baked() -> None:
    cube, world = bpy.data.objects["Cube"], bpy.context.scene.world
    tree = world.node_tree
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    tree.links.new(texture.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 2.0
    followed = world_light(world)
    assert followed is not None
    assert followed.strength == 2.0
    assert follows_world(cube)
    cube.rsibr_baked.light = "WORLD"
    assert not follows_world(cube)
    cube.rsibr_baked.light = "STUDIO"
    assert follows_world(cube)
    cube.rsibr.follow_world = False
    assert not follows_world(cube)


def test_objects_that_follow_the_world_have_its_light() -> None:
    other = bpy.data.objects["Cube"].copy()
    other.rsibr.follow_world = False
    bpy.context.scene.collection.objects.link(other)
    contents = Contents([], None, WorldLight(2.0, np.eye(3)))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    lights = {
        surface.item.name: contents.light_of(surface).strength
        for surface, _ in visible_surfaces.surfaces(depsgraph)
    }
    assert lights == {"Cube": 2.0, other.name: 1.0}


def test_paths_are_those_of_the_open_file(tmp_path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "room.blend"))
    chosen = bpy.context.scene.rsibr_bake.radiance_views
    chosen.source, chosen.preset = "PRESET", "copper"
    chosen.view_file = "//views.txt"
    assert options_of(RadianceViewsSettings, chosen).view_file == str(tmp_path / "views.txt")

"""The operator that adds the light of a room, and the rooms that objects stand for."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.geometry.near_room import Room
from rsibr.rsibr_addon.host.option_properties import options_of
from rsibr.rsibr_addon.host.rooms import room_of
from rsibr.rsibr_addon.settings.mip_chain import MipChainSettings
from rsibr.rsibr_addon.settings.probes import probes_from_text

pytestmark = pytest.mark.usefixtures("registered")


def test_objects_stand_for_rooms() -> None:
    bpy.ops.mesh.primitive_cube_add(size=2.0, location=(1.0, 2.0, 3.0), scale=(1.0, 2.0, 0.5))
    bpy.context.view_layer.update()
    assert room_of(bpy.context.object) == (Room.BOX, (2.0, 4.0, 1.0), (1.0, 2.0, 3.0))
    for shape, room in (("CUBE", Room.BOX), ("SPHERE", Room.SPHERE)):
        bpy.ops.object.empty_add(type=shape, radius=1.5, location=(0.0, -1.0, 0.0))
        bpy.context.object.scale = (1.0, 1.0, 2.0)
        bpy.context.view_layer.update()
        found, size, middle = room_of(bpy.context.object)
        assert found is room
        np.testing.assert_allclose((size, middle), ((3.0, 3.0, 6.0), (0.0, -1.0, 0.0)), atol=1e-6)


def test_probes_are_added_one_behind_the_other(tmp_path: Path) -> None:
    hall = tmp_path / "hall.exr"
    hall.touch()
    bpy.context.scene.rsibr_bake.kind = "kernel_bank"
    assert not bpy.ops.rsibr.add_probe.poll()
    bpy.context.scene.rsibr_bake.kind = "mip_chain"
    bpy.ops.rsibr.add_probe(light=str(hall), size=(4.0, 5.0, 3.0), at=(0.0, 0.0, 1.5))
    bpy.ops.rsibr.add_probe(light=str(hall), room="sphere", middle=(9.0, 0.0, 0.1), blend=0.25)
    first, second = probes_from_text(bpy.context.scene.rsibr_bake.mip_chain.probes)
    assert (first.light, first.room, first.size, first.at) == (
        str(hall), Room.BOX, (4.0, 5.0, 3.0), (0.0, 0.0, 1.5),
    )  # fmt: skip
    assert (second.room, second.middle, second.blend) == (Room.SPHERE, (9.0, 0.0, 0.1), 0.25)
    bpy.ops.rsibr.add_probe(light="forest")
    assert probes_from_text(bpy.context.scene.rsibr_bake.mip_chain.probes)[2].light == "forest"
    with pytest.raises(RuntimeError, match="There is no file"):
        bpy.ops.rsibr.add_probe(light=str(tmp_path / "none.exr"))


def test_files_in_texts_are_beside_the_blender_file(tmp_path: Path) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "house.blend"))
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = "mip_chain"
    chosen.mip_chain.probes = "box:light=//hall.exr,size=4/4/4; sphere: light = //rooms/b.exr , blend=1"
    settings = options_of(MipChainSettings, chosen.mip_chain)
    assert [each.light for each in settings.rooms] == [f"{tmp_path}/hall.exr", f"{tmp_path}/rooms/b.exr"]

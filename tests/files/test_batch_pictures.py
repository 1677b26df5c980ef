"""Pictures on a batch's page: spheres, shaded from the map set."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from OpenImageIO import FLOAT, ImageBuf
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.warned import recorded_warnings
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.kernel_bank import KernelBankSettings
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.reflection_tables import ReflectionTablesSettings
from rsibr.rsibr_addon.tasks.batch.pictures import SIZE, map_set_png
from rsibr.rsibr_addon.tasks.methods.bake import bake


@pytest.fixture
def mirror(tmp_path: Path) -> Path:
    """A mirror between a red sky and a blue ground, both brighter than white."""
    light = np.zeros((16, 32, 3), np.float32)
    light[8:, :, 0] = light[:8, :, 2] = 9.0
    write_radiance(tmp_path / "light.exr", light)
    settings = ReflectionTablesSettings(material="chrome", rows=16, diffuse_rows=4)
    output = tmp_path / "mirror.rsibr.exr"
    drain(bake(BakeJob(settings, str(output), Light(environment=str(tmp_path / "light.exr")))))
    return output


def pixels(png: bytes, path: Path) -> np.ndarray:
    path.write_bytes(png)
    return ImageBuf(str(path)).get_pixels(FLOAT)


def test_a_map_set_is_shown_as_a_sphere_in_its_light(mirror: Path, tmp_path: Path) -> None:
    shown = pixels(map_set_png(mirror), tmp_path / "sphere.png")
    assert shown.shape == (SIZE, SIZE, 4)
    above, below = shown[SIZE // 4, SIZE // 2], shown[3 * SIZE // 4, SIZE // 2]
    # Shown as far as white reaches, with the ground in the lower half
    assert above[0] > 0.9 > 0.1 > above[2]
    assert below[2] > 0.9 > 0.1 > below[0]
    disk = np.hypot(*(np.indices((SIZE, SIZE)) + 0.5 - SIZE / 2))
    np.testing.assert_array_equal(shown[..., 3][disk > SIZE / 2 + 1], 0.0)
    np.testing.assert_array_equal(shown[..., 3][disk < SIZE / 2 - 1], 1.0)


def test_its_picture_needs_no_blender(mirror: Path) -> None:
    code = "import sys; from rsibr.rsibr_addon.tasks.batch.pictures import map_set_png as png; "
    code += f"from pathlib import Path; png(Path({str(mirror)!r})); assert 'bpy' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_kernel_bank_is_shown_as_blender_s_default_material(tmp_path: Path) -> None:
    write_radiance(tmp_path / "light.exr", np.ones((8, 16, 3), np.float32))
    light, output = Light(environment=str(tmp_path / "light.exr")), tmp_path / "bank.rsibr.exr"
    with recorded_warnings():
        drain(bake(BakeJob(KernelBankSettings(size=16), str(output), light)))
    shown = pixels(map_set_png(output), tmp_path / "sphere.png")
    facing = shown[SIZE // 2, SIZE // 2, :3]
    # Its albedo is close to the base colour of .8; a draft of one lobe is a tenth off
    np.testing.assert_allclose(facing, srgb_from_linear(np.full(3, 0.8)), atol=0.05)

"""`rsibr mips` and its operator: right files, and one sentence for everything else."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_from_harmonics
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact
from rsibr.rsibr_addon.core.filtering.radial_lobes import ggx_n_dot_l_lobe
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.geometry.directions import reflect
from rsibr.rsibr_addon.core.kinds.mip_chain.chain import MipChain
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.kinds.mip_chain import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.mirror_capture import radiance_from
from rsibr.tests.open_file import open_file_state

CUBE = representation("cube_map")


@pytest.fixture
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """An environment, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    radiance = np.random.default_rng(51).random((64, 128, 3), dtype=np.float32) ** 4
    write_radiance(tmp_path / "light.exr", radiance)
    return radiance


def bake(*options: str) -> MipChain:
    path = Path("out.rsibr.exr")
    assert run(["mips", "--environment", "light.exr", "-o", str(path), *options]) == 0
    return from_map_set(path, read_map_set(path, "mip_chain"))


def test_ggx_mips_are_the_exact_sum_within_what_the_file_promises(
    light: np.ndarray, capfd: pytest.CaptureFixture[str]
) -> None:
    chain = bake("--size", "16", "--roughness", "0,0.4,0.9", "--json")
    assert json.loads(capfd.readouterr().out.splitlines()[-1])["map_set"] == "out.rsibr.exr"
    assert chain.roughness == (0.0, 0.4, 0.9)
    promised = read_map_set("out.rsibr.exr").header["error_bound"]["relative_to_peak"]
    assert 0.0 < promised < 0.01
    for mip in (1, 2):
        lobe = ggx_n_dot_l_lobe(chain.roughness[mip] ** 2)
        exact = prefilter_exact(light, [lobe], CUBE.texel_directions(16 >> mip))[0]
        assert np.abs(chain.mips[mip] - exact).max() <= promised * exact.max()


@pytest.mark.parametrize("name", ["box", "bordered"])
def test_texture_space_mips_keep_the_light(light: np.ndarray, name: str) -> None:
    chain = bake("--size", "16", "--filter", name)
    assert (len(chain.mips), chain.roughness) == (5, None)
    whole = np.einsum("fji,fjic->c", CUBE.texel_solid_angle(16), chain.mips[0])
    # The first harmonic's coefficient is the light of all directions times 0.282.
    np.testing.assert_allclose(whole * np.sqrt(0.25 / np.pi), chain.harmonics[0], rtol=1e-3)
    assert irradiance_from_harmonics(chain.harmonics, (0.0, 0.0, 1.0)).min() > 0.0
    # Its mips are what they are said to be, but for the rounding of 32-bit floats
    assert read_map_set("out.rsibr.exr").header["error_bound"] == {"relative_to_peak": 2.0**-24}


@pytest.mark.slow
@pytest.mark.needs("gl")
def test_a_chain_is_previewed_as_it_is_asked_for(light: np.ndarray) -> None:
    chain = bake("--size", "16", "--filter", "bordered")
    look = ["--f0", "1", "--mip", "9.4", "--size", "32"]
    assert run(["preview", "out.rsibr.exr", *look, "-o", "ball.exr"]) == 0
    picture = read_exr(Path("ball.exr"))
    shown = picture[picture[..., 3] == 1.0, :3]
    smallest = chain.mips[-1].reshape(-1, 3)
    assert np.all(shown > smallest.min(axis=0) - 1e-4)
    assert np.all(shown < smallest.max(axis=0) + 1e-4)
    assert run(["preview", "out.rsibr.exr", "--kd", "0.5,0,0", "--f0", "0", "-o", "red.exr"]) == 0
    red = read_exr(Path("red.exr"))
    middle = red[200:300, 200:300]
    assert middle[..., 0].min() > 10.0 * middle[..., 1].max()


@pytest.mark.needs("gl")
@pytest.mark.parametrize("name", ["ggx", "bordered"])
def test_a_mirrored_sphere_shows_its_surroundings(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    write_radiance(tmp_path / "light.exr", radiance_from(equirect.direction_from_uv(texel_centres(256, 128))))
    bake("--filter", name, "--size", "64")
    view = ["--view", "0.3,-0.8,0.45", "--f0", "1", "--size", "48"]
    assert run(["preview", "out.rsibr.exr", *view, "-o", "ball.exr"]) == 0
    camera = Camera((0.3, -0.8, 0.45))
    normals = sphere_map.normal_from_uv(texel_centres(48, 48)) @ camera.frame.T
    expected = radiance_from(reflect(np.broadcast_to(camera.view_dir, normals.shape), normals))
    inside = np.linalg.norm(2.0 * texel_centres(48, 48) - 1.0, axis=-1) < 0.9
    # As of captured mirrors (test_preview.py): interpolation of texels, here twice, and a pixel's average.
    assert np.abs(read_exr(Path("ball.exr"))[..., :3] - expected)[inside].max() < 0.015


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--size", "48"], "A mip chain cannot be 48 texels wide: choose a power of 2 up to 1024."),
        (["--size", "2048"], "Size cannot be 2048 texels: choose 1 to 1024."),
        (["--size", "16", "--roughness", "0,0.7,0.5"], "Roughnesses 0, 0.7, 0.5 do not ascend"),
        (["--size", "2", "--roughness", "0,0.5,1"], "A chain from 2 texels has 1 to 2 mips, not 3"),
        (["--filter", "box", "--roughness", "0,1"], "The filter box knows no roughness: leave it out"),
        (
            ["--size", "16", "--roughness", "0,0.01"],
            "Mip 1 cannot have roughness 0.01, choose a larger one: A lobe",
        ),
        (["--environment", "missing.exr"], "missing.exr does not exist: check the name"),
    ],
)
def test_errors_are_one_sentence_and_leave_nothing(
    light: np.ndarray, capfd: pytest.CaptureFixture[str], options: list[str], told: str
) -> None:
    assert run(["mips", "--environment", "light.exr", "-o", "out.rsibr.exr", *options]) == 1
    out, err = capfd.readouterr()
    assert out == ""
    (line,) = (line for line in err.splitlines() if line.startswith("rsibr: error: "))
    assert line.removeprefix("rsibr: error: ").startswith(told)
    assert [path.name for path in Path.cwd().iterdir()] == ["light.exr"]


def test_a_rule_that_there_is_not_is_wrong_usage(capfd: pytest.CaptureFixture[str]) -> None:
    assert run(["mips", "--environment", "light.exr", "-o", "out.rsibr.exr", "--roughness", "cubic"]) == 2
    assert "'cubic' is not one of linear, quadratic or a number" in capfd.readouterr().err


def test_existing_files_are_kept(light: np.ndarray, capfd: pytest.CaptureFixture[str]) -> None:
    Path("out.rsibr.exr").write_text("precious")
    assert run(["mips", "--environment", "light.exr", "-o", "out.rsibr.exr"]) == 1
    assert "out.rsibr.exr exists" in capfd.readouterr().err
    assert Path("out.rsibr.exr").read_text() == "precious"


@pytest.mark.usefixtures("registered")
def test_the_operator_writes_what_the_command_writes(light: np.ndarray) -> None:
    before = open_file_state()
    options = {"filter": "bordered", "size": 64, "environment": "light.exr"}
    assert bpy.ops.rsibr.bake_mip_chain(filepath="operator.exr", **options) == {"FINISHED"}
    assert open_file_state() == before
    bake("--filter", "bordered", "--size", "64")
    assert Path("operator.exr").read_bytes() == Path("out.rsibr.exr").read_bytes()
    with pytest.raises(RuntimeError, match=r"operator\.exr exists: .*"):
        bpy.ops.rsibr.bake_mip_chain(filepath="operator.exr", **options)


@pytest.mark.needs("cycles")
@pytest.mark.usefixtures("registered")
def test_the_operator_takes_the_world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)
    path = tmp_path / "world.rsibr.exr"
    bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.1, 0.2, 0.3, 1.0)
    assert bpy.ops.rsibr.bake_mip_chain(filepath=str(path), filter="box", size=64) == {"FINISHED"}
    chain = from_map_set(path, read_map_set(path))
    np.testing.assert_allclose(chain.mips[-1], np.broadcast_to((0.1, 0.2, 0.3), (6, 1, 1, 3)), rtol=1e-4)

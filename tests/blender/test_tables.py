"""`rsibr tables` and its operator: right files, and one sentence for everything else."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.conventions import texel_centres
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.reflection_tables.material import PRESETS
from rsibr.rsibr_addon.core.kinds.reflection_tables.shading import TablesLook, reflect_tables
from rsibr.rsibr_addon.core.kinds.reflection_tables.tables import ReflectionTables, Role
from rsibr.rsibr_addon.core.maps import equirect, sphere_map
from rsibr.rsibr_addon.files.kinds.reflection_tables import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.pictures import read_exr
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.open_file import open_file_state


@pytest.fixture
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """An environment, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    radiance = np.random.default_rng(52).random((32, 64, 3), dtype=np.float32) ** 4
    write_radiance(tmp_path / "light.exr", radiance)
    return radiance


def bake(*options: str) -> ReflectionTables:
    path = Path("out.rsibr.exr")
    assert run(["tables", "--environment", "light.exr", "-o", str(path), "--force", *options]) == 0
    return from_map_set(path, read_map_set(path, "reflection_tables"))


def test_a_material_is_made_of_parts(light: np.ndarray, capfd: pytest.CaptureFixture[str]) -> None:
    parts = ["--diffuse", "lambert:kd=0.5/0.4/0.3", "--specular", "mirror:", "--coat", "constant:k=0.25"]
    tables = bake(*parts, "--json")
    assert json.loads(capfd.readouterr().out.splitlines()[-1])["map_set"] == "out.rsibr.exr"
    assert [(role, image.shape[0]) for role, image in tables.maps.items()] == [
        (Role.DIFFUSE, 36),
        (Role.SPECULAR, 32),
        (Role.COAT, 32),
    ]
    normals = equirect.direction_from_uv(texel_centres(72, 36))
    expected = np.array([0.5, 0.4, 0.3]) / np.pi * irradiance_exact(light, normals)
    np.testing.assert_allclose(tables.maps[Role.DIFFUSE], expected, rtol=1e-6)
    np.testing.assert_array_equal(tables.maps[Role.SPECULAR], light)
    np.testing.assert_allclose(tables.weights[:3, :, 0], np.repeat([[0.75], [0.75], [0.25]], 64, axis=1))


def test_exact_tables_are_within_the_promised_bound(light: np.ndarray) -> None:
    options = ["--retro", "phong:n=12,ks=0.5", "--rows", "9"]
    filtered = bake(*options).maps[Role.RETRO]
    promised = read_map_set("out.rsibr.exr").header["error_bound"]["retro"]
    exact = bake(*options, "--exact").maps[Role.RETRO]
    assert filtered.shape == (9, 18, 3)
    assert np.all(np.abs(filtered - exact).max(axis=(0, 1)) <= np.array(promised) + 2.0**-23 * exact.max())
    assert 0.0 < max(promised) < 1e-4 * exact.max()


@pytest.mark.parametrize("name", PRESETS)
def test_presets_are_materials_whose_parts_can_be_replaced(light: np.ndarray, name: str) -> None:
    replaced = {"specular": "phong:n=9,ks=0.2", "retro": "phong:n=9,ks=0.2"}
    options = [f"--{part}={text}" for part, text in replaced.items() if part in PRESETS[name]]
    bake("--material", name, *options)
    expected = PRESETS[name] | {part: replaced[part] for part in replaced if part in PRESETS[name]}
    assert read_map_set("out.rsibr.exr").header["material"] == expected


@pytest.mark.needs("gl")
@pytest.mark.parametrize("shown", [None, "diffuse", "coat,refraction"])
def test_a_preview_is_what_the_reference_says(light: np.ndarray, shown: str | None) -> None:
    tables = bake("--diffuse", "lambert:kd=0.5", "--coat", "fresnel:eta=1.5", "--refraction", "clear:eta=1.3")
    look = [] if shown is None else ["--tables", shown]
    view = ["--view", "0.3,-1,0.4", "--size", "32"]
    assert run(["preview", "out.rsibr.exr", *view, *look, "-o", "ball.exr"]) == 0
    picture = read_exr(Path("ball.exr"))
    camera = Camera((0.3, -1.0, 0.4))
    fine = 2.0 * texel_centres(128, 128) - 1.0
    normal = sphere_map.normal_from_uv(0.5 * fine + 0.5) @ camera.frame.T
    roles = TablesLook() if shown is None else TablesLook(tuple(shown.split(",")))
    expected = reflect_tables(tables, normal, camera.view_dir, roles).reshape(32, 4, 32, 4, 3)
    inside = (np.linalg.norm(fine, axis=-1) < 0.9).reshape(32, 4, 32, 4).all(axis=(1, 3))
    # The mesh is made of facets, which turn normals by half a thousandth, and texels here are noise.
    error = np.abs(picture[..., :3] - expected.mean(axis=(1, 3)))[inside]
    assert error.mean() < 2e-3
    assert error.max() < 0.03
    assert expected.std() > 0.02


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ([], "A material needs a table at least: give it a diffuse or a specular part."),
        (["--material", "granite"], "There is no preset granite: choose one of chrome, "),
        (["--diffuse", "0.5"], 'diffuse: there is no model "0.5" for it: choose one of lambert, luminous.'),
        (["--diffuse", "lambert:kd=2"], "diffuse: lambert: kd is 2, but it must be from 0 to 1."),
        (["--specular", "phong:ks=1"], "specular: phong: n is missing; it must be a number from 1 to"),
        (["--specular", "phong:n=5000,ks=1"], "specular: Lobe 1 is 3.24 degrees wide, and a map of 32 rows"),
        (["--coat", "fresnel:metal=tin"], 'coat: fresnel: metal is "tin", but it must be one of'),
        (["--emission", "red"], 'emission: radiance is "red", but it must be one number, or three'),
        (["--refraction", "clear:eta=99"], "refraction: clear: eta is 99, but it must be from 0.1 to 10."),
        (
            ["--diffuse", "lambert:kd=1", "--weights", "albedo:brdf=(merl:path=no.binary)"],
            "no.binary",
        ),
        (
            ["--diffuse", "lambert:kd=1", "--weights", "albedo:brdf=(phong:n=9,ks=1)"],
            "The weights' BRDF has a specular part, so the material needs a specular table.",
        ),
        (["--material", "clay", "--rows", "9000"], "Rows cannot be 9000 texels: choose 1 to 8192."),
    ],
)
def test_what_cannot_be_done_is_one_sentence(
    light: np.ndarray, capfd: pytest.CaptureFixture[str], options: list[str], told: str
) -> None:
    assert run(["tables", "--environment", "light.exr", "-o", "out.exr", "--progress", "none", *options]) == 1
    error = capfd.readouterr().err.strip().splitlines()[-1]
    assert error.startswith("rsibr: error: ")
    assert told in error
    assert not Path("out.exr").exists()


@pytest.mark.parametrize("shown", ["chrome", "diffuse,"])
def test_a_preview_of_no_such_table_is_one_sentence(
    light: np.ndarray, capfd: pytest.CaptureFixture[str], shown: str
) -> None:
    bake("--material", "clay")
    assert run(["preview", "out.rsibr.exr", "--tables", shown, "-o", "ball.exr"]) == 2
    assert "is not one of diffuse, specular, coat, retro, refraction" in capfd.readouterr().err
    assert not Path("ball.exr").exists()


def test_a_material_that_is_too_bright_gets_a_warning(
    light: np.ndarray, capfd: pytest.CaptureFixture[str]
) -> None:
    bake("--diffuse", "lambert:kd=0.9", "--specular", "mirror:")
    assert "rsibr: warning: The material reflects 1.9 times the light it receives" in capfd.readouterr().err


@pytest.mark.usefixtures("registered")
def test_the_operator_writes_what_the_command_writes(light: np.ndarray) -> None:
    before = open_file_state()
    result = bpy.ops.rsibr.bake_reflection_tables(
        filepath="op.exr", environment="light.exr", preset="plastic", specular="phong:n=9,ks=0.1", rows=12
    )
    assert result == {"FINISHED"}
    assert open_file_state() == before
    bake("--material", "plastic", "--specular", "phong:n=9,ks=0.1", "--rows", "12")
    assert Path("op.exr").read_bytes() == Path("out.rsibr.exr").read_bytes()
    with pytest.raises(RuntimeError, match=r"op\.exr exists: "):
        bpy.ops.rsibr.bake_reflection_tables(filepath="op.exr", environment="light.exr", preset="clay")
    with pytest.raises(RuntimeError, match="A material needs a table at least"):
        bpy.ops.rsibr.bake_reflection_tables(filepath="new.exr", environment="light.exr", preset="none")
    assert not Path("new.exr").exists()


@pytest.mark.needs("cycles")
@pytest.mark.usefixtures("registered")
def test_the_operator_takes_the_world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rsibr.rsibr_addon.tasks.light.environments.WORLD_HEIGHT", 16)
    path = tmp_path / "world.rsibr.exr"
    assert bpy.ops.rsibr.bake_reflection_tables(filepath=str(path), preset="clay") == {"FINISHED"}
    tables = from_map_set(path, read_map_set(path))
    # The factory file's world is an even grey.
    grey = bpy.context.scene.world.node_tree.nodes["Background"].inputs["Color"].default_value[0]
    clay = np.array([0.55, 0.4, 0.3])
    expected = np.broadcast_to(clay * grey, tables.maps[Role.DIFFUSE].shape)
    np.testing.assert_allclose(tables.maps[Role.DIFFUSE], expected, rtol=2e-2)

"""The operators that make light from photographs do what the commands do, and tell what they cannot do."""

from pathlib import Path

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.ball_circle import Circle
from rsibr.rsibr_addon.core.light.ball_photograph import BallSide
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.environments import read_environment
from rsibr.rsibr_addon.files.map_pictures import LIKELY, layout, write_map
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.tasks.light.light_pictures import light_remarks, offered_layouts
from rsibr.tests.open_file import open_file_state
from rsibr.tests.synthetic_ball import ball_photograph, surroundings
from rsibr.tests.written_pictures import write_png

pytestmark = pytest.mark.usefixtures("registered")

RNG = np.random.default_rng(11)
TIMES = (2.0, 0.1, 0.5)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def by_command(*arguments: object) -> bytes:
    out = Path("command.exr")
    assert run(["illuminate", *map(str, arguments), "-o", str(out), "--force"]) == 0
    return out.read_bytes()


def by_operator(name: str, **properties: object) -> bytes:
    before = open_file_state()
    given = {"output": "operator.exr", "force": True, "load_image": False, **properties}
    assert getattr(bpy.ops.rsibr, name)(**given) == {"FINISHED"}
    assert open_file_state() == before
    return Path("operator.exr").read_bytes()


def several(folder: Path, *names: str) -> dict[str, object]:
    """What the file browser sets."""
    return {
        "directory": f"{folder}/",
        "filepath": str(folder / names[0]),
        "files": [{"name": name} for name in names],
    }


def write_brackets(folder: Path) -> list[str]:
    radiance = np.geomspace(0.02, 8.0, 600).reshape(20, 30)[..., None] * np.array([1.0, 0.5, 0.8])
    for i, time in enumerate(TIMES):
        write_radiance(folder / f"{i}.exr", np.minimum(radiance * time, 1.0))
    return [f"{i}.exr" for i in range(len(TIMES))]


def write_ball(path: Path, turn: float = 0.0) -> None:
    side = BallSide(np.zeros((2, 2, 3)), np.radians(turn), 0.0, np.inf)
    write_radiance(path, ball_photograph(side, Circle(101.0, 92.0, 80.0), 200, 180, camera=0.2))


def write_faces(path: Path) -> None:
    write_map(path, layout("cube_faces"), RNG.uniform(0.5, 2.0, (6, 16, 16, 3)))


def write_painting(path: Path) -> None:
    write_png(path, RNG.integers(0, 255, (8, 16, 3), dtype=np.uint8, endpoint=True))


def test_brackets(folder: Path) -> None:
    names = write_brackets(folder)
    expected = by_command("brackets", *names, "--times", "2,1/10,0.5", "--no-align")
    chosen = several(folder, *names)
    assert by_operator("merge_brackets", **chosen, times="2, 1/10 0.5", align=False) == expected
    names = [f"{i}.png" for i in range(len(TIMES))]
    for name in names:
        write_png(folder / name, RNG.integers(20, 230, (20, 30, 3), dtype=np.uint8))
    expected = by_command("brackets", *names, "--times", "4,2,1", "--curve", "srgb")
    assert by_operator("merge_brackets", **several(folder, *names), times="4 2 1", curve="srgb") == expected


def test_a_ball(folder: Path) -> None:
    write_ball(folder / "a.exr")
    expected = by_command("ball", "a.exr", "--size", 32)
    assert by_operator("unwrap_ball", filepath=str(folder / "a.exr"), size=32) == expected
    expected = by_command("ball", "a.exr", "--circle", "101,88,80", "--distance", 5, "--size", 32)
    given = {"filepath": str(folder / "a.exr"), "size": 32, "circle": (101.0, 88.0, 80.0)}
    assert by_operator("unwrap_ball", **given, distance=5.0) == expected
    scaled = ["--circle", "101,88,80", "--size", 32, "--exposure", 1.5, "--white-balance", "0.5,0.25,0.25"]
    expected = by_command("ball", "a.exr", *scaled, "--reflectance", 0.5)
    given |= {"use_exposure": True, "exposure": 1.5, "white_balance": (0.5, 0.25, 0.25)}
    assert by_operator("unwrap_ball", **given, reflectance=(0.5, 0.5, 0.5)) == expected
    expected = by_command("ball", "a.exr", "--circle", "101,88,80", "--size", 32, "--card", "12,15,8")
    given |= {"use_exposure": False, "white_balance": (0.0, 0.0, 0.0)}
    assert by_operator("unwrap_ball", **given, card=(12.0, 15.0, 8.0)) == expected


def test_a_ball_from_two_sides(folder: Path) -> None:
    write_ball(folder / "a.exr")
    write_ball(folder / "b.exr", turn=90.0)
    angles = {"field_of_view": 30.0, "elevation": 7.0, "camera": 14.0, "turn": 86.0}
    command = ["ball", "a.exr", "--second", "b.exr", "--circle", "101,88,80", "--second-circle", "100,89,80"]
    command += ["--fov", 30, "--elevation", 7, "--camera", 14, "--turn", 86, "--size", 32]
    expected = by_command(*command)
    given = {"size": 32, "circle": (101.0, 88.0, 80.0), "second_circle": (100.0, 89.0, 80.0)}
    given |= {name: np.radians(angle) for name, angle in angles.items()}
    assert by_operator("unwrap_ball", **several(folder, "a.exr", "b.exr"), **given) == expected
    # Not so by one of them alone
    assert by_operator("unwrap_ball", **several(folder, "a.exr"), **given) != expected


@pytest.mark.parametrize("balance", [False, True])
def test_faces_by_any_of_them(folder: Path, balance: bool) -> None:
    write_faces(folder / "a.exr")
    expected = by_command("faces", "a.exr", "--size", 32, *(["--balance"] if balance else []))
    for name in ("a-px.exr", "a-nz.exr", "a.exr"):
        path = str(folder / name)
        assert by_operator("assemble_faces", filepath=path, balance=balance, size=32) == expected


def test_a_painting(folder: Path) -> None:
    write_painting(folder / "a.png")
    expected = by_command("painted", "a.png", "--white", "50,40,30", "--knee", 0.5, "--size", 16)
    given = {"filepath": str(folder / "a.png"), "white": (50.0, 40.0, 30.0), "knee": 0.5, "size": 16}
    assert by_operator("lift_painting", **given) == expected
    # The end of the range, which single precision misses
    expected = by_command("painted", "a.png", "--white", 10, "--knee", 0.99, "--size", 16)
    assert by_operator("lift_painting", filepath=str(folder / "a.png"), knee=0.99, size=16) == expected
    for sheet in layout("cube_faces").representation.sheets:
        write_png(folder / f"b-{sheet}.png", RNG.integers(0, 255, (8, 8, 3), dtype=np.uint8, endpoint=True))
    command = ["painted", "b.png", "--from", "cube_faces", "--white", 10, "--knee", 0.5, "--size", 16]
    given = {"filepath": str(folder / "b-ny.png"), "source_layout": "cube_faces", "knee": 0.5, "size": 16}
    assert by_operator("lift_painting", **given) == by_command(*command)


def test_the_result_lies_beside_and_can_be_loaded_and_used(folder: Path) -> None:
    write_faces(folder / "room.exr")
    given = {"filepath": str(folder / "room-px.exr"), "size": 16}
    assert bpy.ops.rsibr.assemble_faces(**given, use=True) == {"FINISHED"}
    light = folder / "room-light.exr"
    assert light.is_file()
    (image,) = (image for image in bpy.data.images if image.name == "room-light.exr")
    try:
        assert tuple(image.size) == (16, 8)
        chosen = bpy.context.scene.rsibr_bake
        assert (chosen.light, Path(bpy.path.abspath(chosen.picture))) == ("PICTURE", light)
    finally:
        bpy.data.images.remove(image)


@pytest.mark.parametrize("name", LIKELY[1:])
def test_a_picture_in_another_layout_is_offered_and_converted(folder: Path, name: str) -> None:
    known = layout(name)
    size = 128 if len(known.representation.sheets) == 1 else 64
    directions = known.representation.texel_directions(size)
    written = write_map(folder / "probe.exr", known, surroundings(directions))
    assert name in offered_layouts(written[0])
    given = {"filepath": str(written[0]), "source_layout": name, "use": True, "load_image": False}
    assert bpy.ops.rsibr.convert_light(**given) == {"FINISHED"}
    light = written[0].with_name(f"{written[0].stem}-from-{name.replace('_', '-')}.exr")
    chosen = bpy.context.scene.rsibr_bake
    assert (chosen.light, Path(bpy.path.abspath(chosen.picture))) == ("PICTURE", light)
    assert offered_layouts(light) == () == light_remarks(light)
    found = read_environment(light).radiance
    assert found.shape[0] * found.shape[1] >= size**2 * len(written)
    expected = surroundings(representation("equirect").texel_directions(found.shape[1])[0])
    # A mirror ball shows what is behind it in ever fewer texels
    error = np.abs(found - expected) / expected.max()
    assert np.quantile(error, 0.9) < 0.02


def test_what_is_offered_for_each_shape(folder: Path) -> None:
    write_radiance(folder / "square.exr", np.ones((60, 60, 3)))
    write_radiance(folder / "cross.exr", np.ones((40, 30, 3)))
    write_radiance(folder / "odd.exr", np.ones((41, 30, 3)))
    (folder / "photograph.jpg").write_bytes(b"JPEG")
    disks = ("angular_map", "mirror_ball", "octahedral", "sphere_map")
    assert offered_layouts(folder / "square.exr") == disks
    assert offered_layouts(folder / "cross.exr") == ("cube_cross",)
    for name in ("odd.exr", "photograph.jpg", "absent.exr"):
        assert offered_layouts(folder / name) == ()
    (remark,) = light_remarks(folder / "odd.exr")
    assert remark == "odd.exr is 30x41, and an environment is twice as wide as high: convert it."


def test_errors_are_reports(folder: Path) -> None:
    names = write_brackets(folder)
    write_ball(folder / "ball.exr")
    write_faces(folder / "a.exr")
    write_radiance(folder / "flat.exr", np.ones((60, 60, 3)))
    there = sorted(folder.iterdir())
    before = open_file_state()

    def refused(complaint: str, name: str, **properties: object) -> None:
        with pytest.raises(RuntimeError, match=complaint):
            getattr(bpy.ops.rsibr, name)(**properties)

    for operator in ("merge_brackets", "unwrap_ball", "assemble_faces", "lift_painting"):
        refused("No picture is chosen: select one", operator)
    # As of a browser in which none is selected
    refused("No picture is chosen", "merge_brackets", directory=f"{folder}/", files=[{"name": ""}])
    bracket, ball = several(folder, *names), str(folder / "ball.exr")
    refused(r"0\.exr does not tell its exposure time: give", "merge_brackets", **bracket)
    refused("3 photographs have 2 exposure times", "merge_brackets", **bracket, times="1,2")
    refused("'soon' is not a number: give numbers", "merge_brackets", **bracket, times="soon")
    refused("One photograph is no bracket", "merge_brackets", **several(folder, "0.exr"), times="1")
    refused("There are 3 photographs of the ball: select one or two", "unwrap_ball", **bracket)
    refused(
        "both tell where the camera was: give one of them",
        "unwrap_ball",
        filepath=ball,
        distance=5,
        field_of_view=0.2,
    )
    refused("the circle 500,500,80 is not in it", "unwrap_ball", filepath=ball, circle=(500, 500, 80))
    refused(r"flat\.exr: ", "unwrap_ball", filepath=str(folder / "flat.exr"))
    refused(r"absent\.exr as cube_faces is 6 files", "assemble_faces", filepath=str(folder / "absent-px.exr"))
    refused("cannot be 17 texels wide", "assemble_faces", filepath=str(folder / "a-px.exr"), size=17)
    refused("holds radiance already", "lift_painting", filepath=ball)
    refused(r"a-px\.exr exists", "assemble_faces", filepath=str(folder / "a-px.exr"), output="a-px.exr")
    assert open_file_state() == before
    assert sorted(folder.iterdir()) == there

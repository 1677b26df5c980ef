"""`rsibr convert` on pictures of radiance, without Blender: layouts on disk, and bad input."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.errors import InputFileError, RangeError
from rsibr.rsibr_addon.core.maps.representation import REPRESENTATIONS, representation
from rsibr.rsibr_addon.files.map_pictures import CUBES, layout, read_map, write_map
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.rsibr_addon.settings.environment import LAYOUTS

RNG = np.random.default_rng(0)
DIRECTION = {
    "px": (1, 0, 0),
    "nx": (-1, 0, 0),
    "py": (0, 0, 1),
    "ny": (0, 0, -1),
    "pz": (0, 1, 0),
    "nz": (0, -1, 0),
}
"""Where a cube's pictures look, in the world: right, left, up, down, ahead and back."""


def direction_picture(size: int = 256) -> np.ndarray:
    """A latitude-longitude map whose radiance is 2 + direction."""
    return (2.0 + representation("equirect").texel_directions(size)[0]).astype(np.float32)


def convert(*arguments: object) -> int:
    return run(["convert", *map(str, arguments)])


def test_the_command_knows_every_layout() -> None:
    assert set(LAYOUTS) == (set(REPRESENTATIONS) - {"cube_map"}) | set(CUBES)


@pytest.mark.parametrize("name", LAYOUTS)
def test_every_layout_is_read_as_it_was_written(tmp_path: Path, name: str) -> None:
    some = layout(name)
    image = RNG.random((*some.representation.shape(8), 3)).astype(np.float32)
    written = write_map(tmp_path / "a.exr", some, image)
    assert sorted(written) == sorted(tmp_path.iterdir())
    np.testing.assert_array_equal(read_map(tmp_path / "a.exr", some, read_radiance), image)


@pytest.mark.parametrize("name", LAYOUTS)
def test_from_a_latlong_to_every_layout_and_back(tmp_path: Path, name: str) -> None:
    write_radiance(tmp_path / "room.exr", direction_picture())
    there, back = tmp_path / "there.exr", tmp_path / "back.hdr"
    more = ["--overscan", 1.2] if name == "dual_paraboloid" else []
    more += ["--distance", 50] if name == "mirror_ball" else []
    assert convert(tmp_path / "room.exr", there, "--from", "equirect", "--to", name, "--size", 64, *more) == 0
    assert convert(there, back, "--from", name, "--to", "equirect", "--size", 64, *more) == 0
    found, expected = read_radiance(back), direction_picture(64)
    # Half a step of the file, 3 / 256, and some of two times half a texel of 2 pi / 64; at the rims of some
    # maps texels are sqrt(4 / 64) long, and a sphere map has a singularity there
    assert np.quantile(np.abs(found - expected), 0.95) < 0.05
    assert np.abs(found - expected).max() < (0.5 if name in ("sphere_map", "mirror_ball") else 0.15)


@pytest.mark.parametrize("name", LAYOUTS)
def test_the_map_that_a_file_belongs_to(name: str) -> None:
    for path in (Path("some", "room-1.exr"), Path("-.exr")):
        files = layout(name).paths(path)
        assert [layout(name).whole(file) for file in (path, *files)] == [path] * (len(files) + 1)
    assert layout(name).whole(Path("-px.exr")) == Path("-px.exr")


def face_pictures(folder: Path) -> dict[str, np.ndarray]:
    write_radiance(folder / "room.exr", direction_picture(64))
    arguments = ["--from", "equirect", "--to", "cube_faces", "--size", 8]
    assert convert(folder / "room.exr", folder / "c.exr", *arguments) == 0
    return {name: read_radiance(folder / f"c-{name}.exr") for name in DIRECTION}


def test_faces_are_six_photographs_taken_while_looking_along_y(tmp_path: Path) -> None:
    pictures = face_pictures(tmp_path)
    for name, picture in pictures.items():
        # The middle of a picture shows where it looks
        middle = picture[3:5, 3:5].mean(axis=(0, 1)) - 2.0
        np.testing.assert_allclose(middle, DIRECTION[name], atol=0.05)
    # Row 0 is the bottom. All around, the sky is above; ahead, the last column shows what lies to the right
    for name in ("px", "nx", "pz", "nz"):
        assert pictures[name][7, :, 2].min() > 2.4 > 1.6 > pictures[name][0, :, 2].max()
    assert pictures["pz"][:, 7, 0].min() > 2.4
    # The picture of the sky has at its bottom what is ahead
    assert pictures["py"][0, :, 1].min() > 2.4
    assert pictures["ny"][7, :, 1].min() > 2.4


def test_a_cross_unfolds_without_seams(tmp_path: Path) -> None:
    pictures = face_pictures(tmp_path)
    arguments = ["--from", "cube_faces", "--to", "cube_cross", "--size", 8]
    assert convert(tmp_path / "c.exr", tmp_path / "x.exr", *arguments) == 0
    cross = read_radiance(tmp_path / "x.exr")
    assert cross.shape == (24, 32, 3)
    np.testing.assert_array_equal(cross[8:16, 8:16], pictures["pz"])
    np.testing.assert_array_equal(cross[16:24, 8:16], pictures["py"])
    np.testing.assert_array_equal(cross[8:16, 24:32], pictures["nz"])
    assert np.all(cross[:8, 16:] == 0.0)
    # From picture to picture, directions change as much as within one
    row, column = cross[8:16], cross[:, 8:16]
    assert np.abs(np.diff(row, axis=1)).max() < 0.3
    assert np.abs(np.diff(column, axis=0)).max() < 0.3


def test_upright_crosses_and_strips_are_read_too(tmp_path: Path) -> None:
    pictures = face_pictures(tmp_path)
    upright = np.zeros((32, 24, 3))
    for name, row, column in [("py", 3, 1), ("nx", 2, 0), ("pz", 2, 1), ("px", 2, 2), ("ny", 1, 1)]:
        upright[8 * row : 8 * row + 8, 8 * column : 8 * column + 8] = pictures[name]
    # Below the floor comes what is behind, which then stands on its head
    upright[:8, 8:16] = pictures["nz"][::-1, ::-1]
    assert np.abs(np.diff(upright[:, 8:16], axis=0)).max() < 0.3
    write_radiance(tmp_path / "x.exr", upright)
    faces = read_map(tmp_path / "c.exr", layout("cube_faces"), read_radiance)
    np.testing.assert_array_equal(read_map(tmp_path / "x.exr", layout("cube_cross"), read_radiance), faces)
    write_radiance(tmp_path / "s.exr", np.concatenate([pictures[name] for name in reversed(DIRECTION)]))
    np.testing.assert_array_equal(read_map(tmp_path / "s.exr", layout("cube_strip"), read_radiance), faces)


def test_a_cube_with_five_faces_is_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    face_pictures(tmp_path)
    (tmp_path / "c-ny.exr").unlink()
    capfd.readouterr()
    arguments = ["--from", "cube_faces", "--to", "equirect", "--size", 8]
    assert convert(tmp_path / "c.exr", tmp_path / "out.exr", *arguments) == 1
    error = capfd.readouterr().err
    assert "is 6 files, of which c-ny.exr is missing" in error
    assert not (tmp_path / "out.exr").exists()


@pytest.mark.parametrize(
    ("name", "width", "height", "told"),
    [
        ("equirect", 8, 8, "a.exr is 8x8, but equirect is twice as wide as high"),
        ("equirect", 9, 4, "a.exr is 9x4, but equirect is twice as wide as high"),
        ("angular_map", 8, 4, "a.exr is 8x4, but angular_map is square"),
        ("cube_cross", 8, 8, "a.exr is 8x8, but cube_cross is six square faces in a picture of 4:3 or 3:4"),
        ("cube_cross", 9, 6, "six square faces"),
        ("cube_strip", 13, 2, "six square faces in a picture of 6:1 or 1:6"),
        ("cube_strip", 5, 1, "six square faces"),
    ],
)
def test_a_layout_that_the_size_does_not_fit_is_refused(
    tmp_path: Path, name: str, width: int, height: int, told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    write_radiance(tmp_path / "a.exr", np.ones((height, width, 3)))
    arguments = ["--from", name, "--to", "octahedral", "--size", 8]
    assert convert(tmp_path / "a.exr", tmp_path / "b.exr", *arguments) == 1
    assert told in capfd.readouterr().err
    assert not (tmp_path / "b.exr").exists()


def test_sheets_of_different_sizes_or_shapes_are_refused(tmp_path: Path) -> None:
    write_radiance(tmp_path / "a-front.exr", np.ones((4, 4, 3)))
    write_radiance(tmp_path / "a-back.exr", np.ones((5, 5, 3)))
    with pytest.raises(InputFileError, match=r"a-back\.exr is 5x5, but a-front\.exr is 4x4"):
        read_map(tmp_path / "a.exr", layout("orthographic"), read_radiance)
    for side in ("front", "back"):
        write_radiance(tmp_path / f"a-{side}.exr", np.ones((4, 5, 3)), force=True)
    with pytest.raises(InputFileError, match=r"a-front\.exr is 5x4, but orthographic is square"):
        read_map(tmp_path / "a.exr", layout("orthographic"), read_radiance)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--to", "octahedral", "--size", 8, "--overscan", 1.2], "Neither map is a dual_paraboloid"),
        (["--to", "octahedral", "--size", 8, "--distance", 9], "Neither map is a mirror_ball"),
        (
            ["--to", "dual_paraboloid", "--size", 8, "--overscan", 0.9],
            "Overscan cannot be 0.9: choose 1 to 1000",
        ),
        (
            ["--to", "mirror_ball", "--size", 8, "--distance", "nan"],
            "Distance cannot be nan: choose 1.001 to",
        ),
        (["--to", "equirect", "--size", 7], "choose a multiple of 2"),
        (["--to", "octahedral", "--size", 20000], "Size cannot be 20000 texels: choose 1 to 16384"),
    ],
)
def test_parameters_out_of_range_are_refused(
    tmp_path: Path, arguments: list, told: str, capfd: pytest.CaptureFixture[str]
) -> None:
    write_radiance(tmp_path / "a.exr", direction_picture(8))
    assert convert(tmp_path / "a.exr", tmp_path / "b.exr", "--from", "equirect", *arguments) == 1
    assert told in capfd.readouterr().err


def test_values_that_are_no_radiance(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    picture = direction_picture(8)
    picture[0, 0, 0], picture[0, 0, 1], picture[1, 1, 1] = np.nan, np.inf, -1.0
    write_radiance(tmp_path / "a.exr", picture)
    arguments = ["--from", "equirect", "--to", "equirect", "--size", 8]
    assert convert(tmp_path / "a.exr", tmp_path / "b.exr", *arguments) == 0
    told = capfd.readouterr().err
    greatest = picture.max(where=np.isfinite(picture), initial=0.0)
    assert f"a.exr holds 1 infinite values; they are taken as {greatest:g}." in told
    assert "a.exr holds 1 undefined (NaN) values; they are taken as 0." in told
    assert "a.exr holds 1 negative values; they are taken as 0." in told
    made = read_radiance(tmp_path / "b.exr")
    assert (made[0, 0, 0], made[0, 0, 1], made[1, 1, 1]) == (0.0, greatest, 0.0)
    assert convert(tmp_path / "a.exr", tmp_path / "c.exr", *arguments, "--clamp", 2) == 0
    brighter = np.count_nonzero(picture > 2.0)
    assert f"a.exr holds {brighter} values above 2; they are taken as 2." in capfd.readouterr().err
    np.testing.assert_array_equal(read_radiance(tmp_path / "c.exr"), np.minimum(made, 2.0))


def test_outputs_are_kept_and_none_is_written_when_one_is_there(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_radiance(tmp_path / "a.exr", direction_picture(8))
    (tmp_path / "b-back.exr").write_bytes(b"kept")
    arguments = [
        tmp_path / "a.exr",
        tmp_path / "b.exr",
        "--from",
        "equirect",
        "--to",
        "orthographic",
        "--size",
        8,
    ]
    assert convert(*arguments) == 1
    assert "b-back.exr exists" in capfd.readouterr().err
    assert not (tmp_path / "b-front.exr").exists()
    assert convert(*arguments, "--force", "--json") == 0
    assert "b-front.exr" in capfd.readouterr().out


def test_a_disk_that_fills_up_after_two_faces_gets_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    write_radiance(tmp_path / "room.exr", direction_picture())
    sync, synced = os.fsync, []

    def fill_up(descriptor: int) -> None:
        synced.append(descriptor)
        if len(synced) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(descriptor)

    command = [tmp_path / "room.exr", tmp_path / "a.exr", *("--from", "equirect", "--to", "cube_faces")]
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fill_up)
        assert convert(*command, "--size", 8) == 75
    assert "a-py.exr was not written because the disk is full" in capfd.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["room.exr"]
    assert convert(*command, "--size", 8) == 0


def test_wrong_layouts_are_usage_errors(tmp_path: Path) -> None:
    assert convert("a.exr", "b.exr", "--from", "equirect", "--to", "hexagon", "--size", 8) == 2
    with pytest.raises(RangeError, match="no maps of kind hexagon"):
        layout("hexagon")

"""`rsibr illuminate ball` on pictures of radiance, without Blender."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.ball_circle import Circle
from rsibr.rsibr_addon.core.light.ball_photograph import BallSide
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.tests.synthetic_ball import ball_photograph, surroundings
from rsibr.tests.written_pictures import ORIENTATION, add_exif, write_png

EXPECTED = surroundings(representation("equirect").texel_directions(64)[0])
CIRCLE = Circle(101.0, 92.0, 80.0)
"""In a photograph of 200x180: 88 from its top."""


def illuminate(*arguments: object) -> int:
    return run(["illuminate", "ball", *map(str, arguments), "--exposure", "0"])


def write_side(path: Path, turn: float = 0.0, distance: float = np.inf, scale: float = 1.0) -> Path:
    side = BallSide(np.zeros((2, 2, 3)), np.radians(turn), 0.0, distance)
    write_radiance(path, scale * ball_photograph(side, CIRCLE, 200, 180, camera=0.2) / 0.8)
    return path


def median_error(path: Path) -> float:
    return float(np.median(np.abs(read_radiance(path) / EXPECTED - 1.0)))


def test_a_ball_is_found_and_unwrapped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    ball, out = write_side(tmp_path / "ball.exr"), tmp_path / "room.exr"
    assert illuminate(ball, "-o", out, "--size", 64, "--json") == 0
    ((path, *circle),) = json.loads(capfd.readouterr().out)["circles"]
    assert path == str(ball)
    np.testing.assert_allclose(circle, (101.0, 88.0, 80.0), atol=1.0)
    # A pixel off is two degrees of reflection: a fifth of a radian's detail of 15 degrees
    assert median_error(out) < 0.08
    assert illuminate(ball, "--circle", "101,88,80", "-o", out, "--size", 64, "--force") == 0
    assert median_error(out) < 0.02


def test_a_turned_photograph_stands_upright(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    # Of a camera held upright: what is stored lies on its side, 180x200, and Exif says how
    side = BallSide(np.zeros((2, 2, 3)))
    light = np.minimum(ball_photograph(side, CIRCLE, 200, 180) / 4.0, 1.0)
    encoded = np.round(255 * srgb_from_linear(light)).astype(np.uint8)
    ball, out = tmp_path / "ball.png", tmp_path / "room.exr"
    write_png(ball, np.rot90(encoded[::-1])[::-1])
    add_exif(ball, {ORIENTATION: 6})
    arguments = ["--circle", "88,99,80", "-o", out, "--size", 64, "--json"]
    assert illuminate(ball, *arguments) == 0
    assert json.loads(capfd.readouterr().out)["circles"][0][1:] == [88.0, 99.0, 80.0]
    # Rounded to 8 bits, and in units of what was white
    room = read_radiance(out)
    assert np.median(np.abs(5.0 * room / EXPECTED - 1.0)) < 0.03
    assert illuminate(ball, "--circle", "101,300,80", "-o", out, "--force") == 1
    assert "ball.png is stored as 180x200, but the circle 101,300,80 is not in it" in capfd.readouterr().err


def test_two_sides_near_by(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    first = write_side(tmp_path / "a.exr", 0.0, 5.0)
    second = write_side(tmp_path / "b.exr", 110.0, 5.0, scale=0.5)
    out = tmp_path / "room.exr"
    arguments = [first, "--second", second, "--turn", 110, "--circle", "101,88,80"]
    arguments += ["--second-circle", "101,88,80", "-o", out, "--size", 64, "--json"]
    assert illuminate(*arguments, "--distance", 5) == 0
    assert json.loads(capfd.readouterr().out)["gains"] == pytest.approx([1.0, 2.0], rel=0.02)
    assert np.quantile(np.abs(read_radiance(out) / EXPECTED - 1.0), 0.98) < 0.15
    # The same distance by the angle that 200 pixels show: 80 pixels are tan(asin(1 / 5)) focal lengths
    angle = 2.0 * np.degrees(np.arctan(100.0 / (80.0 / np.tan(np.arcsin(0.2)))))
    before = read_radiance(out)
    assert illuminate(*arguments, "--fov", angle, "--force") == 0
    np.testing.assert_allclose(read_radiance(out), before, rtol=1e-4)


def test_exposures_of_different_crops_are_merged(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    side = BallSide(np.zeros((2, 2, 3)))
    paths = []
    for i, (time, circle) in enumerate([(0.25, CIRCLE), (1.0, Circle(98.0, 90.0, 82.0))]):
        photograph = ball_photograph(side, circle, 200 - 3 * i, 180 + 2 * i)
        write_radiance(tmp_path / f"{i}.exr", np.minimum(photograph / 0.8 * time, 1.0))
        paths.append(tmp_path / f"{i}.exr")
    out = tmp_path / "room.exr"
    assert illuminate(*paths, "--times", "0.25,1", "-o", out, "--size", 64) == 0
    capfd.readouterr()
    assert median_error(out) < 0.08


@pytest.mark.filterwarnings("ignore::rsibr.rsibr_addon.core.errors.RsibrWarning")
def test_a_ball_is_clamped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    ball, out = write_side(tmp_path / "ball.exr"), tmp_path / "room.exr"
    given = ["--circle", "101,88,80", "-o", out, "--size", 64, "--clamp", 0.5, "--force"]
    clamped = 0.5 * 1.001  # shares of a texel's mean sum to 1 but for quadrature
    assert EXPECTED.max() > 1.0
    assert illuminate(ball, *given) == 0
    assert 0.49 < read_radiance(out).max() < clamped
    assert illuminate(ball, ball, "--times", "1,2", *given) == 0
    assert 0.49 < read_radiance(out).max() < clamped
    assert "as 0.5" in capfd.readouterr().err


@pytest.mark.slow
def test_bad_input_is_told_and_nothing_written(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    ball, out = write_side(tmp_path / "ball.exr"), tmp_path / "room.exr"

    def told(*arguments: object) -> str:
        assert illuminate(*arguments, "-o", out) == 1
        assert not out.exists()
        return capfd.readouterr().err

    write_radiance(tmp_path / "noise.exr", np.random.default_rng(0).random((80, 100, 3)))
    nothing = told(tmp_path / "noise.exr")
    assert "noise.exr: No ball was found: let it fill most of the photograph" in nothing
    assert "ball.exr is stored as 200x180, but the circle 500,88,80 is not in it" in told(
        ball, "--circle", "500,88,80"
    )
    assert "ball.exr: A circle is x, y and a radius above 0" in told(ball, "--circle", "100,88,0")
    assert "Distance cannot be 0.5: choose 1.001 to" in told(ball, "--distance", 0.5)
    assert "cannot be 63 texels wide" in told(ball, "--size", 63)
    assert "Elevation cannot be 90 degrees: choose -89 to 89" in told(ball, "--elevation", 90)
    assert "Camera cannot be -1 degrees: choose 0 to 179" in told(ball, "--camera", -1)
    times = ["--times", 1, "--times-file", tmp_path / "times.txt"]
    assert "1 photograph has 2 exposure times" in told(ball, "--times", "1,2")
    assert "leave one of the two out" in told(ball, *times)
    assert "Distance and field of view both tell" in told(ball, "--distance", 5, "--fov", 50)
    assert "ball.exr does not tell its exposure time" in told(ball, ball)
    write_radiance(tmp_path / "black.exr", np.zeros((180, 200, 3)))
    sides = [
        ball,
        "--second",
        tmp_path / "black.exr",
        "--second-circle",
        "101,88,80",
        "--circle",
        "101,88,80",
    ]
    assert "share nothing but black" in told(*sides)


def test_wrong_circles_are_wrong_usage(tmp_path: Path) -> None:
    for circle in ("1,2", "a,b,c", "1,2,3,4"):
        assert illuminate("a.exr", "--circle", circle, "-o", tmp_path / "b.exr") == 2

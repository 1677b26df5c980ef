"""Exposure, white balance, grey cards and a ball's reflectance of `rsibr illuminate`, without Blender."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.fresnel import fresnel_schlick
from rsibr.rsibr_addon.core.filtering.irradiance import irradiance_exact
from rsibr.rsibr_addon.core.geometry.directions import normalize
from rsibr.rsibr_addon.core.light.ball_circle import Circle
from rsibr.rsibr_addon.core.light.ball_photograph import BallSide
from rsibr.rsibr_addon.core.light.luminance import luminance
from rsibr.rsibr_addon.core.light.transfer_curve import srgb_from_linear
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.files.radiance_pictures import describe_radiance, read_radiance, write_radiance
from rsibr.tests.synthetic_ball import ball_photograph, surroundings
from rsibr.tests.written_pictures import ORIENTATION, add_exif, write_png

EXPECTED = surroundings(representation("equirect").texel_directions(64)[0])
CIRCLE = Circle(101.0, 92.0, 80.0)
GIVEN = ("--circle", "101,88,80", "--size", "64")
CARD = np.array([0.4, 0.3, 0.2])


def illuminate(kind: str, *arguments: object) -> int:
    return run(["illuminate", kind, *map(str, arguments)])


def ball(path: Path, reflectance: np.ndarray | float = 1.0) -> Path:
    """A ball, and a card of `CARD` in the top left corner, 20 pixels wide."""
    picture = ball_photograph(BallSide(np.zeros((2, 2, 3))), CIRCLE, 200, 180) / 0.8
    x, y = np.arange(200) + 0.5 - CIRCLE.x, np.arange(180)[:, None] + 0.5 - CIRCLE.y
    away = np.hypot(x, y) / CIRCLE.radius
    # Seen from afar, the incidence's sine is the distance from the middle
    cosine = np.sqrt(np.maximum(1.0 - away**2, 0.0))[..., None]
    picture = np.where(away[..., None] < 1.0, fresnel_schlick(cosine, reflectance) * picture, picture)
    picture[-20:, :20] = CARD
    write_radiance(path, picture)
    return path


def grey_card(radiance: np.ndarray) -> float:
    """What a grey card shows that is turned to the most light, from many sides."""
    normals = normalize(np.random.default_rng(3).normal(size=(3000, 3)))
    irradiance = irradiance_exact(luminance(radiance)[..., None], normals)
    return float(0.18 * irradiance.max() / np.pi)


@pytest.mark.parametrize("kind", ["exr", "hdr"])
def test_a_ball_is_made_so_bright_that_a_grey_card_is_middle_grey(
    tmp_path: Path, kind: str, capfd: pytest.CaptureFixture[str]
) -> None:
    source = ball(tmp_path / "ball.exr")
    write_radiance(source, 1000.0 * read_radiance(source), force=True)
    out = tmp_path / f"room.{kind}"
    assert illuminate("ball", source, *GIVEN, "-o", out, "--json") == 0
    told = json.loads(capfd.readouterr().out)["scale"]
    made = read_radiance(out)
    # Ways to turn a card are some degrees apart; HDR keeps 8 bits
    assert grey_card(made) == pytest.approx(0.18, rel=0.02)
    factor = float(told.split()[2])
    np.testing.assert_allclose(np.median(made / EXPECTED), 1000.0 * factor, rtol=0.02)
    assert told.endswith("white, 1, is what a white card shows that is turned to the most light.")
    assert describe_radiance(out).comments == told
    assert run(["info", str(out)]) == 0
    assert told in capfd.readouterr().out


def test_a_photograph_that_cuts_lamps_off_shows_what_is_lit(tmp_path: Path) -> None:
    light = np.minimum(read_radiance(ball(tmp_path / "light.exr")) / 1.5, 1.0)
    source, out = tmp_path / "ball.png", tmp_path / "room.exr"
    write_png(source, np.round(255 * srgb_from_linear(light)).astype(np.uint8)[::-1])
    assert illuminate("ball", source, *GIVEN, "-o", out) == 0
    share = np.broadcast_to(representation("equirect").texel_solid_angle(64)[0], (32, 64))
    above = share[luminance(read_radiance(out)) > 1.0].sum() / share.sum()
    assert 0.03 < above < 0.07
    assert "all but a twentieth of the directions are below white" in describe_radiance(out).comments


def test_exposure_leaves_light_as_it_was_taken(tmp_path: Path) -> None:
    source, out = ball(tmp_path / "ball.exr"), tmp_path / "room.exr"
    for stops, factor in ((0, 1.0), (2, 4.0), (-1, 0.5)):
        assert illuminate("ball", source, *GIVEN, "--exposure", stops, "-o", out, "--force") == 0
        assert np.median(np.abs(read_radiance(out) / (factor * EXPECTED) - 1.0)) < 0.02
    assert "1 stop darker" in describe_radiance(out).comments


def test_a_card_shows_its_albedo(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source, out = ball(tmp_path / "ball.exr"), tmp_path / "room.exr"
    card = ("--card", "10,10,8", "--albedo", "0.2,0.3,0.4")
    assert illuminate("ball", source, *GIVEN, *card, "-o", out) == 0
    gains = np.array([0.2, 0.3, 0.4]) / CARD
    assert np.median(np.abs(read_radiance(out) / (gains * EXPECTED) - 1.0)) < 0.02
    assert "a card of albedo 0.2, 0.3, 0.4 shows just that" in describe_radiance(out).comments
    assert illuminate("ball", source, *GIVEN, *card, "--exposure", 1, "-o", out, "--force") == 0
    assert np.median(np.abs(read_radiance(out) / (2.0 * gains * EXPECTED) - 1.0)) < 0.02
    capfd.readouterr()
    assert illuminate("ball", source, *GIVEN, "--card", "900,10,8", "-o", out, "--force") == 1
    assert "ball.exr: The circle 900,10,8 of the card holds no pixel" in capfd.readouterr().err
    both = ("--card", "10,10,8", "--white-balance", "1,1,1")
    assert illuminate("ball", source, *GIVEN, *both, "-o", out, "--force") == 1
    assert "A card and a white balance both tell the colour" in capfd.readouterr().err
    assert illuminate("ball", source, source, "--times", "1,2", *card, "-o", out, "--force") == 1
    assert "merge them by rsibr illuminate brackets" in capfd.readouterr().err


def test_a_card_is_where_it_is_stored(tmp_path: Path) -> None:
    # As a camera held upright stores it: on its side
    light = np.minimum(read_radiance(ball(tmp_path / "light.exr")) / 4.0, 1.0)
    source, out = tmp_path / "ball.png", tmp_path / "room.exr"
    write_png(source, np.rot90(np.round(255 * srgb_from_linear(light)).astype(np.uint8)[::-1])[::-1])
    add_exif(source, {ORIENTATION: 6})
    given = ("--circle", "88,99,80", "--size", "64", "--card", "10,190,8")
    assert illuminate("ball", source, *given, "-o", out) == 0
    assert np.median(np.abs(read_radiance(out) / (0.18 / CARD * EXPECTED) - 1.0)) < 0.04


def test_white_balance_makes_a_colour_grey(tmp_path: Path) -> None:
    source, out = ball(tmp_path / "ball.exr"), tmp_path / "room.exr"
    given = (*GIVEN, "--white-balance", "0.4,0.3,0.2", "--exposure", 0, "-o", out)
    assert illuminate("ball", source, *given) == 0
    gains = luminance(CARD) / CARD
    assert np.median(np.abs(read_radiance(out) / (gains * EXPECTED) - 1.0)) < 0.02


def test_a_balls_own_reflectance_is_divided_out(tmp_path: Path) -> None:
    copper, out = np.array([0.95, 0.64, 0.54]), tmp_path / "room.exr"
    source = ball(tmp_path / "ball.exr", copper)
    given = (*GIVEN, "--exposure", 0, "-o", out, "--force")
    assert illuminate("ball", source, *given) == 0
    assert np.median(np.abs(read_radiance(out) / EXPECTED - 1.0)[..., 2]) > 0.2
    assert illuminate("ball", source, *given, "--reflectance", "0.95,0.64,0.54") == 0
    error = np.abs(read_radiance(out) / EXPECTED - 1.0)
    assert np.median(error) < 0.02
    # The outline reflects all: there too, but where few pixels show much of what is behind the ball
    assert np.quantile(error, 0.9) < 0.12


def test_pictures_that_are_merged_or_painted_are_scaled_where_asked(tmp_path: Path) -> None:
    picture = np.full((16, 32, 3), (0.4, 0.3, 0.2))
    paths = []
    for i, time in enumerate((0.5, 1.0)):
        paths.append(tmp_path / f"{i}.exr")
        write_radiance(paths[-1], time * picture)
    out = tmp_path / "merged.exr"
    merge = ("--times", "0.5,1", "--no-align", "-o", out, "--force")
    assert illuminate("brackets", *paths, *merge) == 0
    plain = read_radiance(out)
    assert describe_radiance(out).comments == ""
    assert illuminate("brackets", *paths, *merge, "--exposure", -3) == 0
    np.testing.assert_allclose(read_radiance(out), plain / 8.0, rtol=1e-5)
    assert illuminate("brackets", *paths, *merge, "--card", "16,8,4") == 0
    np.testing.assert_allclose(read_radiance(out), 0.18, rtol=1e-4)
    write_png(tmp_path / "sky.png", np.full((16, 32, 3), 100, np.uint8))
    painted = ("--white", 10, "--size", 32, "-o", out, "--force")
    assert illuminate("painted", tmp_path / "sky.png", *painted) == 0
    plain = read_radiance(out)
    assert illuminate("painted", tmp_path / "sky.png", *painted, "--exposure", 1) == 0
    np.testing.assert_allclose(read_radiance(out), 2.0 * plain, rtol=1e-5)

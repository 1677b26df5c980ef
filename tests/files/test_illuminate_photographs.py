"""`rsibr illuminate` on pictures of 8 bits, and on photographs taken by others."""

import json
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.tests.measurements import measurement
from rsibr.tests.written_pictures import write_png


def illuminate(*arguments: object) -> int:
    return run(["illuminate", *map(str, arguments)])


def test_painted_whites_become_lamps(tmp_path: Path) -> None:
    pixels = np.full((8, 16, 3), 100, np.uint8)
    pixels[6, 4:6] = 255
    write_png(tmp_path / "a.png", pixels)
    out = tmp_path / "a.exr"
    assert illuminate("painted", tmp_path / "a.png", "--white", "50,40,30", "-o", out, "--size", 16) == 0
    radiance = read_radiance(out)
    np.testing.assert_allclose(radiance[6, 4], (50, 40, 30), rtol=1e-6)
    np.testing.assert_allclose(radiance[2], linear_from_srgb(100 / 255), rtol=1e-6)


def test_bad_paintings_are_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_png(tmp_path / "a.png", np.zeros((8, 10, 3), np.uint8))
    out = tmp_path / "a.exr"

    def told(*arguments: object) -> str:
        assert illuminate("painted", *arguments, "-o", out) == 1
        assert not out.exists()
        return capfd.readouterr().err

    picture = tmp_path / "a.png"
    assert "a.png is 10x8, but equirect is twice as wide as high" in told(picture, "--white", 5)
    write_png(picture, np.zeros((8, 8, 3), np.uint8))
    angular = [picture, "--from", "angular_map"]
    assert "White cannot be 0.5: choose a number from 1" in told(*angular, "--white", 0.5)
    assert "Knee cannot be 1: choose 0 to 0.99" in told(*angular, "--white", 5, "--knee", 1)
    write_radiance(tmp_path / "b.exr", np.ones((8, 8, 3)))
    radiance = told(tmp_path / "b.exr", "--from", "angular_map", "--white", 5)
    assert "b.exr holds radiance already: use rsibr convert" in radiance


@pytest.mark.slow
def test_the_memorial_church_is_merged_as_others_have(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder, out = measurement("brackets/memorial"), tmp_path / "church.exr"
    photographs = sorted(folder.glob("*.png"))
    times = folder / "shutter_times.txt"
    assert illuminate("brackets", *photographs, "--times-file", times, "-o", out, "--json") == 0
    result = json.loads(capfd.readouterr().out)
    # Registered by those who made them, up to their rotation
    assert 0.0 < result["moved"] < 1.5
    # The borders that they filled with blue
    assert result["saturated"] < 0.05
    ours = read_radiance(out)[30:-30, 15:-15].astype(np.float64)
    theirs = read_radiance(folder / "qhan_debevec_radiance.hdr")[30:-30, 15:-15].astype(np.float64)
    # Where theirs is no edge, which a fraction of a pixel moves, and not in the fog of the film's black
    brightness = np.log(theirs.mean(axis=-1) + 1e-4)
    told = (np.hypot(*np.gradient(brightness)) < 0.1) & (theirs.min(axis=-1) > 0.02)
    assert told.mean() > 0.15
    ratio = np.log(ours[told] / theirs[told])
    error = np.expm1(np.abs(ratio - np.median(ratio)))
    # The film's response is known to each of us to some percent, and the longest exposures have less
    # effect than their times say, by 3 to 5 % a stop
    assert np.median(error) < 0.08
    assert np.quantile(error, 0.9) < 0.25


@pytest.mark.slow
def test_a_mirror_ball_by_hand_is_unwrapped(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    photographs = sorted(measurement("brackets/mirror_ball").glob("*.jpg"))
    out = tmp_path / "room.exr"
    assert illuminate("ball", *photographs, "--elevation", 20, "-o", out, "--size", 256, "--json") == 0
    result = json.loads(capfd.readouterr().out)
    # They are cropped to the ball: its middle is theirs, and its radius half their shorter side
    for (_, x, y, radius), (width, height) in zip(
        result["circles"], ((490, 480), (484, 468), (480, 472)), strict=True
    ):
        assert (x, y) == pytest.approx((width / 2, height / 2), abs=0.02 * width)
        assert radius == pytest.approx(min(width, height) / 2, rel=0.03)
    room = read_radiance(out)
    # Lamps shine from above: most of the light that is far brighter than the room
    brightness = room.mean(axis=-1)
    lamps = np.where(brightness > 8.0 * np.median(brightness), brightness, 0.0)
    assert lamps[64:].sum() > 4.0 * lamps[:64].sum() > 0.0

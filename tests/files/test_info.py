"""`rsibr info` of pictures: what would be used of them."""

import json
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.light.light_range import light_range
from rsibr.tests.written_pictures import EXPOSURE_TIME, F_NUMBER, ISO, ORIENTATION, add_exif, write_png


def told(path: Path, capfd: pytest.CaptureFixture[str]) -> dict:
    """The result as a program gets it."""
    assert run(["info", str(path), "--json"]) == 0
    return json.loads(capfd.readouterr().out)


def test_a_layer_of_a_render(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    pixels = np.full((8, 16, 3), 0.5, np.float32)
    pixels[0, 0] = np.inf, -1.0, np.nan
    pixels[1, 1] = 0.0, 3e-6, 700.0
    planes = {f"V.Combined.{name}": np.ascontiguousarray(pixels[..., i]) for i, name in enumerate("RGB")}
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION, "interim": 1}
    OpenEXR.File(header, planes | {"V.Mist.Z": pixels[..., 0].copy()}).write(str(tmp_path / "a.exr"))
    result = told(tmp_path / "a.exr", capfd)
    assert result["facts"]["size"] == [16, 8]
    assert result["facts"]["channels"] == "V.Combined.R, V.Combined.G, V.Combined.B"
    assert result["light"] == {
        "peak": 700.0,
        "dark_end": float(np.float32(3e-6)),
        "mean": pytest.approx((0.5 * (8 * 16 * 3 - 6) + 700.0) / (8 * 16 * 3 - 3)),
        "black": 1,
        "negative": 1,
        "infinite": 1,
        "undefined": 1,
    }
    assert result["warnings"] == [f"{tmp_path / 'a.exr'} has attributes that are not used: interim."]
    assert run(["info", f"{tmp_path / 'a.exr'}:Combined"]) == 0
    assert "  exposure     none stated\n  light        peak 700, mean " in capfd.readouterr().out


def test_an_exposure_and_a_square_picture(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(b"#?RADIANCE\nEXPOSURE=2\n\n-Y 2 +X 2\n" + bytes([128, 128, 128, 129]) * 4)
    result = told(path, capfd)
    assert result["facts"]["exposure"] == "2 2 2, divided out"
    assert result["light"]["peak"] == result["light"]["mean"] == 0.5
    assert run(["info", str(path)]) == 0
    assert "not twice as wide as high" in capfd.readouterr().out


def test_a_photograph_is_said_to_be_no_radiance(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    OpenImageIO.ImageBuf(np.full((4, 8, 3), 255, np.uint8)).write(str(tmp_path / "a.png"))
    assert run(["info", str(tmp_path / "a.png")]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].endswith("a.png: 8 bits a colour, 8x4")
    assert lines[1:3] == ["  colours      srgb_rec709_scene", "  exposure     not told"]
    assert lines[3].startswith("  radiance     none: lamps end at white")
    assert lines[4].startswith("  light        peak 1, ")


def test_what_is_used_of_a_photograph_is_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_png(tmp_path / "a.png", np.full((4, 8, 3), 255, np.uint8), (b"gAMA", bytes((0, 1, 134, 160))))
    add_exif(tmp_path / "a.png", {ORIENTATION: 8, EXPOSURE_TIME: (1, 40), F_NUMBER: (4, 1), ISO: 200})
    assert run(["info", str(tmp_path / "a.png")]) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].endswith("8 bits a colour, 4x8")
    assert lines[1:3] == ["  turned       upright, as its Exif says", "  colours      lin_rec709_scene"]
    assert lines[3] == "  exposure     0.025 s, f/4, ISO 200"
    assert lines[4].startswith("  light ")
    assert told(tmp_path / "a.png", capfd)["facts"] == {
        "bits": 8,
        "size": [4, 8],
        "turned": True,
        "colours": "lin_rec709_scene",
        "exposure": {"time": float(np.float32(0.025)), "f_number": 4.0, "sensitivity": 200.0},
        "is_radiance": True,
    }


@pytest.mark.parametrize("content", [b"", b"text", b"#?RADIANCE\n\n-Y 9 +X 9\n", b"\x76\x2f\x31\x01"])
def test_what_cannot_be_read_is_one_sentence(
    tmp_path: Path, content: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.exr").write_bytes(content)
    assert run(["info", str(tmp_path / "a.exr")]) == 1
    assert capfd.readouterr().err.count("\n") == 1


def test_a_picture_without_light_has_no_dark_end() -> None:
    assert light_range(np.zeros((2, 4, 3))).dark_end == 0.0


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.exr", b"just text", "is not OpenEXR, whatever its name says"),
        ("a.EXR", b"", "is not OpenEXR, whatever its name says"),
        ("a.hdr", b"just text", "is not Radiance HDR, whatever its name says"),
        ("a.hdr", b"#?RADIANCE\n\n-Y 2 +X 2\n" + bytes([128, 128, 128, 129]), "is truncated"),
    ],
)
def test_what_is_no_picture_or_damaged_is_refused_and_nothing_else_is_said(
    name: str, text: bytes, told: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_bytes(text)
    assert run(["info", str(tmp_path / name)]) == 1
    out, err = capfd.readouterr()
    assert out == ""
    assert told in err
    assert "EXR Error" not in err

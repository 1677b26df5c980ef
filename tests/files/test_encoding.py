"""What numbers in pictures mean: named colour spaces, ICC profiles and PNG's statements."""

import struct
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.light.transfer_curve import linear_from_srgb
from rsibr.rsibr_addon.files.chromaticities import REC_709, rec709_from
from rsibr.rsibr_addon.files.encoding import PRIMARIES, named_encoding, profile_encoding
from rsibr.rsibr_addon.files.photographs import read_photograph
from rsibr.tests.written_pictures import P3, SRGB, parametric, profile, sampled, write_picture, write_png

LEVELS = np.linspace(0.0, 1.0, 101)
REC_709_COLORANTS = np.array([[0.4361, 0.2225, 0.0139], [0.3851, 0.7169, 0.0971], [0.1431, 0.0606, 0.7139]])
REC_2020 = struct.pack(">8I", *(round(1e5 * each) for each in np.roll(PRIMARIES["rec2020"], 2)))
"""As PNG puts it: white comes first."""

PIXELS = np.random.default_rng(0).integers(0, 255, (4, 6, 3), dtype=np.uint8, endpoint=True)


@pytest.mark.parametrize(
    ("curve", "expected"),
    [
        (SRGB, linear_from_srgb(LEVELS)),
        (parametric(0, 2.2), LEVELS**2.2),
        (parametric(1, 2.0, 1.25, -0.25), np.maximum(1.25 * LEVELS - 0.25, 0.0) ** 2),
        (parametric(2, 2.0, 1.0, 0.0, 0.25), 0.25 + LEVELS**2),
        (
            parametric(4, 2.0, 1.0, 0.0, 0.5, 0.5, 0.1, 0.2),
            np.where(LEVELS >= 0.5, LEVELS**2 + 0.1, LEVELS / 2 + 0.2),
        ),
        (sampled(563), LEVELS ** (563 / 256)),
        (sampled(0, 16384, 65535), np.interp(LEVELS, [0.0, 0.5, 1.0], [0.0, 16384 / 65535, 1.0])),
    ],
)
def test_curves_of_profiles(curve: bytes, expected: np.ndarray) -> None:
    encoding = profile_encoding(profile(REC_709_COLORANTS, curve))
    assert encoding.curves is not None
    # Numbers in profiles are fractions of 65536
    np.testing.assert_allclose(encoding.curves[1](LEVELS), expected, atol=1e-4)
    np.testing.assert_array_equal(encoding.to_rec709, np.eye(3))


@pytest.mark.parametrize("curve", [sampled(), sampled(256), parametric(0, 1.0)])
def test_a_straight_curve_is_linear(curve: bytes) -> None:
    assert profile_encoding(profile(REC_709_COLORANTS, curve)).curves is None


def test_display_p3_is_the_same_by_profile_and_by_name() -> None:
    named = named_encoding("srgb_p3d65_scene").to_rec709
    by_profile = profile_encoding(profile(P3, SRGB)).to_rec709
    np.testing.assert_allclose(by_profile, named, atol=1e-3)
    np.testing.assert_allclose(named.sum(axis=1), 1.0, rtol=1e-12)
    assert named[0, 0] > 1.2


def test_a_photograph_in_display_p3_is_converted(tmp_path: Path) -> None:
    for path in (tmp_path / "a.png", tmp_path / "a.tif"):
        write_picture(path, PIXELS, ICCProfile=profile(P3, SRGB))
        expected = np.maximum(linear_from_srgb(PIXELS / 255) @ rec709_from(PRIMARIES["p3d65"]).T, 0.0)
        np.testing.assert_allclose(read_photograph(path).radiance(), expected, atol=2e-3)


@pytest.mark.parametrize("damaged", [b"", b"text" * 50, profile(P3, b"curv"), profile(P3, SRGB)[:150]])
def test_a_profile_that_cannot_be_used_is_told(damaged: bytes) -> None:
    with pytest.raises(ValueError, match="it has no primaries with curves"):
        profile_encoding(damaged)


@pytest.mark.parametrize(
    ("curve", "why"),
    [
        (parametric(0, 0.0), "no primaries with curves"),
        (parametric(0, -2.2), "no primaries with curves"),
        (sampled(0), "no primaries with curves"),
        (parametric(1, 300.0, 300.0, 0.0), "too steep"),
    ],
)
def test_a_curve_that_ends_nowhere_is_refused(curve: bytes, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        profile_encoding(profile(P3, curve))


def test_what_is_too_steep_where_it_does_not_count_does_no_harm() -> None:
    encoding = profile_encoding(profile(P3, parametric(3, 300.0, -300.0, 300.0, 1.0, 2.0)))
    assert encoding.curves is None


def test_a_picture_goes_on_without_its_profile(tmp_path: Path) -> None:
    # A head that promises a table of colours, as printers have
    write_picture(tmp_path / "a.tif", PIXELS, ICCProfile=profile(P3, SRGB).replace(b"TRC", b"xxx"))
    with pytest.warns(RsibrWarning, match=r"a\.tif has a colour profile \(.*\) that cannot be used"):
        light = read_photograph(tmp_path / "a.tif").radiance()
    np.testing.assert_allclose(light, linear_from_srgb(PIXELS / 255), rtol=1e-6)


@pytest.mark.parametrize(
    ("kind", "data", "primaries", "linear"),
    [
        (b"gAMA", struct.pack(">I", 100000), "rec709", True),
        (b"gAMA", struct.pack(">I", 45455), "rec709", False),
        (b"sRGB", b"\0", "rec709", False),
        (b"cICP", bytes((1, 13, 0, 1)), "rec709", False),
        (b"cICP", bytes((12, 13, 0, 1)), "p3d65", False),
        (b"cICP", bytes((1, 8, 0, 1)), "rec709", True),
        (
            b"cHRM",
            struct.pack(">8I", *(round(1e5 * each) for each in np.roll(PRIMARIES["rec2020"], 2))),
            "rec2020",
            False,
        ),
    ],
)
def test_what_a_png_states_is_used(
    tmp_path: Path, kind: bytes, data: bytes, primaries: str, linear: bool
) -> None:
    write_png(tmp_path / "a.png", PIXELS, (kind, data))
    light = PIXELS / 255 if linear else linear_from_srgb(PIXELS / 255)
    expected = np.maximum(light @ rec709_from(PRIMARIES[primaries]).T, 0.0)
    np.testing.assert_allclose(read_photograph(tmp_path / "a.png").radiance(), expected, atol=1e-6)


def test_unknown_spaces_are_told(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", PIXELS, (b"cHRM", bytes(32)))
    with pytest.warns(RsibrWarning, match=r"a\.png is of a colour space .* unknown here"):
        read_photograph(tmp_path / "a.png")
    assert named_encoding("lin_rec709_scene").curves is None
    np.testing.assert_array_equal(rec709_from(REC_709), np.eye(3))

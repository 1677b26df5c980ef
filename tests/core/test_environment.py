"""What may light a scene, and the words for what may not."""

import hashlib
import struct
import warnings

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment, environment_from_pixels
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning

PIXELS = np.arange(24, dtype=np.float32).reshape(2, 4, 3) / 8.0


def test_the_hash_is_that_of_the_numbers() -> None:
    by_hand = hashlib.sha256(struct.pack("<24f", *(i / 8.0 for i in range(24)))).hexdigest()
    assert environment_from_pixels(PIXELS, "room").sha256 == by_hand
    # Map sets record it: it must never change.
    assert by_hand == "ae7641b7016cf6731bb0e41c05c676fc9779a60730a4a52207b30c0abb1e10db"


@pytest.mark.parametrize(
    "same",
    [
        PIXELS.astype(np.float64),
        PIXELS.astype(">f4"),
        np.asfortranarray(PIXELS),
        PIXELS[::-1].copy()[::-1],
    ],
    ids=["double", "big-endian", "columns first", "flipped view"],
)
def test_the_hash_does_not_depend_on_storage(same: np.ndarray) -> None:
    environment = environment_from_pixels(same, "another name")
    assert environment.sha256 == Environment(PIXELS, "room").sha256
    assert environment.radiance.dtype == np.float32
    np.testing.assert_array_equal(environment.radiance, PIXELS)


def test_the_hash_tells_environments_apart() -> None:
    flipped = PIXELS[::-1]
    brighter = np.nextafter(PIXELS, np.float32(np.inf))
    assert len({Environment(pixels, "room").sha256 for pixels in (PIXELS, flipped, brighter)}) == 3


@pytest.mark.parametrize(("height", "width"), [(4, 4), (4, 9), (3, 5), (0, 0)])
def test_a_map_that_is_not_twice_as_wide_as_high_is_refused(height: int, width: int) -> None:
    with pytest.raises(
        InputFileError, match=rf"^room\.exr is {width}x{height}, but .* twice as wide"
    ) as raised:
        environment_from_pixels(np.zeros((height, width, 3)), "room.exr")
    assert "convert it, by rsibr convert or in the panel" in str(raised.value)


def test_values_that_are_no_numbers_are_replaced_and_counted() -> None:
    pixels = PIXELS.copy()
    pixels[0, 0] = np.nan, np.inf, -np.inf
    pixels[1, 3, 2] = np.inf
    before = pixels.copy()
    expected = pixels.copy()
    expected[0, 0] = expected[1, 3, 2] = np.nanmax(pixels, where=np.isfinite(pixels), initial=0.0)
    expected[0, 0, ::2] = 0.0
    with pytest.warns(RsibrWarning) as caught:
        environment = environment_from_pixels(pixels, "room.exr")
    sentences = [str(warning.message) for warning in caught]
    assert sentences[0] == f"room.exr holds 2 infinite values; they are taken as {expected.max():g}."
    assert sentences[1] == "room.exr holds 1 undefined (NaN) values; they are taken as 0."
    assert sentences[2] == "room.exr holds 1 negative values; they are taken as 0."
    np.testing.assert_array_equal(environment.radiance, expected)
    np.testing.assert_array_equal(pixels, before)


def test_what_is_brighter_than_the_clamp_is_the_clamp_with_the_count() -> None:
    pixels = PIXELS.copy()
    pixels[0, 0] = np.inf, 1e30, np.nan
    clamp = float(np.median(PIXELS))
    brighter = np.count_nonzero(pixels > clamp)
    with pytest.warns(RsibrWarning) as caught:
        environment = environment_from_pixels(pixels, "room.exr", clamp)
    assert (
        str(caught[0].message)
        == f"room.exr holds {brighter} values above {clamp:g}; they are taken as {clamp:g}."
    )
    assert str(caught[1].message) == "room.exr holds 1 undefined (NaN) values; they are taken as 0."
    np.testing.assert_array_equal(environment.radiance, np.minimum(np.nan_to_num(pixels), np.float32(clamp)))
    assert environment.clamp == clamp


def test_what_sums_could_not_hold_is_limited_with_the_count() -> None:
    pixels = PIXELS.copy()
    pixels[0, 0] = np.inf, 3e38, 1e30
    with pytest.warns(RsibrWarning) as caught:
        environment = environment_from_pixels(pixels, "room.exr")
    [told] = map(str, (warning.message for warning in caught))
    assert told == "room.exr holds 2 values above 1e+30; they are taken as 1e+30."
    np.testing.assert_array_equal(environment.radiance, np.minimum(pixels, np.float32(1e30)))


def test_nothing_is_said_of_a_clamp_that_changes_nothing() -> None:
    environment = environment_from_pixels(PIXELS, "room.exr", float(PIXELS.max()))
    assert environment.sha256 == environment_from_pixels(PIXELS, "room.exr").sha256


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_map_without_any_finite_value_is_refused(value: float) -> None:
    with pytest.raises(InputFileError, match=r"^room\.exr holds no finite value"):
        environment_from_pixels(np.full((2, 4, 3), value), "room.exr")


def test_negative_values_become_black_with_their_count() -> None:
    pixels = PIXELS.copy()
    pixels[0, 0] = -1.0, -1e-30, 2.0
    before = pixels.copy()
    with pytest.warns(RsibrWarning, match=r"^room\.exr holds 2 negative values; they are taken as 0\.$"):
        environment = environment_from_pixels(pixels, "room.exr")
    np.testing.assert_array_equal(environment.radiance, np.maximum(pixels, 0.0))
    np.testing.assert_array_equal(pixels, before)


def test_negligible_negative_values_become_black_without_a_word() -> None:
    pixels = np.ones((2, 4, 3), dtype=np.float32)
    pixels[0, 0, 0] = -22e-6  # the other 23 are 1: just below a millionth of their sum
    np.testing.assert_array_equal(environment_from_pixels(pixels, "room.exr").radiance, np.maximum(pixels, 0))
    pixels[0, 0, 0] = -24e-6
    with pytest.warns(RsibrWarning, match=r"^room\.exr holds 1 negative values"):
        environment_from_pixels(pixels, "room.exr")


def test_a_good_map_passes_without_a_word() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        environment = environment_from_pixels(PIXELS, "room.exr")
    assert environment.name == "room.exr"

"""MERL files, written here by the format's description, and one made after a real one."""

import struct
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.ggx import Ggx
from rsibr.rsibr_addon.core.brdf.measured_merl import SCALE, SHAPE, below_horizon
from rsibr.rsibr_addon.core.brdf.metals import METALS
from rsibr.rsibr_addon.core.brdf.tabulated import cell_directions
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.merl import SIZE, read_merl
from rsibr.tests.measurements import measurement


def write(path: Path, samples: np.ndarray) -> Path:
    """`samples` (3, 90, 90, 180) as the format stores them: counts, then red, green and blue."""
    path.write_bytes(struct.pack("<3i", *SHAPE) + samples.astype("<f8").tobytes())
    return path


@pytest.fixture
def samples() -> np.ndarray:
    """A constant, and -1 where nothing can be measured."""
    values = np.broadcast_to(np.array([100.0, 200.0, 300.0])[:, None, None, None], (3, *SHAPE)).copy()
    values[:, below_horizon()] = -1.0
    return values


def test_samples_are_read_where_they_belong(tmp_path: Path, samples: np.ndarray) -> None:
    samples[:, 10, 20, 30] = 1500.0, 3000.0, 4500.0
    path = write(tmp_path / "a.binary", samples)
    assert path.stat().st_size == SIZE == 34_992_012
    brdf = read_merl(path)
    assert brdf.spec == f"merl:path={path}"
    np.testing.assert_allclose(brdf.table[10, 20, 30], [1.0, 2.0 * 1.15, 3.0 * 1.66], rtol=1e-12)
    # What is below the horizon is taken from above it, so that nothing is dark beside it
    assert below_horizon()[70, 60, 0]
    np.testing.assert_allclose(brdf.table[70, 60, 0], SCALE * (100.0, 200.0, 300.0), rtol=1e-12)


def test_missing_measurements_are_counted_and_filled(tmp_path: Path, samples: np.ndarray) -> None:
    samples[0, 40, 10, 90] = -1.0
    samples[1, 41, 10, 90] = np.nan
    samples[2, 42, 10, 90] = np.inf
    path = write(tmp_path / "a.binary", samples)
    with pytest.warns(RsibrWarning, match=r"a\.binary lacks 3 measurements above the horizon"):
        brdf = read_merl(path)
    for half in (40, 41, 42):
        np.testing.assert_allclose(brdf.table[half, 10, 90], SCALE * (100.0, 200.0, 300.0), rtol=1e-12)
    write(path, np.full((3, *SHAPE), np.nan))
    with pytest.raises(InputFileError, match="no measurement at all"):
        read_merl(path)


@pytest.mark.parametrize(
    ("header", "rest", "sentence"),
    [
        (b"", 0, "no MERL measurement"),
        (b"abc", 0, "no MERL measurement"),
        (struct.pack("<3i", 90, 90, 360), 0, "no MERL measurement"),
        (struct.pack("<3i", *SHAPE), 0, "shorter than the 34992012 bytes"),
        (struct.pack("<3i", *SHAPE), SIZE - 13, "shorter than"),
        (struct.pack("<3i", *SHAPE), SIZE - 11, "longer than"),
        (struct.pack("<3i", *SHAPE), 2 * SIZE, "longer than"),
    ],
)
def test_damaged_files_are_refused_in_words(tmp_path: Path, header: bytes, rest: int, sentence: str) -> None:
    path = tmp_path / "a.binary"
    with path.open("wb") as stream:
        stream.write(header)
        stream.truncate(len(header) + rest)
    with pytest.raises(InputFileError, match=sentence) as caught:
        read_merl(path)
    assert str(path) in str(caught.value)


def test_a_missing_file_is_said_to_be_missing(tmp_path: Path) -> None:
    with pytest.raises(InputFileError, match="does not exist"):
        read_merl(tmp_path / "gold.binary")


@pytest.mark.slow
def test_a_model_that_is_stored_so_is_itself_and_reciprocal(tmp_path: Path) -> None:
    gold = Ggx(alpha=0.3, fresnel=METALS["gold"])
    light_dir, view_dir = (directions.reshape(-1, 3) for directions in cell_directions(SHAPE))
    samples = np.full((3, *SHAPE), -1.0)
    above = ~below_horizon()
    values = gold(light_dir, view_dir).reshape(*SHAPE, 3) / SCALE
    samples[:, above] = np.moveaxis(values, -1, 0)[:, above]
    brdf = read_merl(write(tmp_path / "gold.binary", samples))
    cells = np.flatnonzero(above)[::997]
    np.testing.assert_allclose(
        brdf(light_dir[cells], view_dir[cells]), gold(light_dir[cells], view_dir[cells]), rtol=1e-9
    )
    np.testing.assert_allclose(
        brdf(light_dir[cells], view_dir[cells]), brdf(view_dir[cells], light_dir[cells]), rtol=1e-6
    )


def test_gold_paint_is_gold_and_reciprocal() -> None:
    path = measurement("brdf/merl/gold-metallic-paint.binary")
    with pytest.warns(RsibrWarning, match="lacks 12070 measurements above the horizon"):
        brdf = read_merl(path)
    albedo = directional_albedo(brdf, [1.0, 0.5, 0.1])
    assert albedo.max() < 0.5
    assert (np.diff(albedo, axis=1) < 0.0).all()  # more red than green than blue
    stored = np.fromfile(path, "<f8", offset=12).reshape(3, *SHAPE)
    cells = (slice(0, 60, 7), slice(3, 50, 9), slice(5, 175, 11))
    light_dir, view_dir = (directions[cells] for directions in cell_directions(SHAPE))
    expected = np.moveaxis(stored[(slice(None), *cells)], 0, -1) * SCALE
    measured = (expected >= 0.0).all(axis=-1)
    assert measured.mean() > 0.9
    np.testing.assert_allclose(brdf(light_dir, view_dir)[measured], expected[measured], rtol=1e-9)
    np.testing.assert_allclose(brdf(light_dir, view_dir), brdf(view_dir, light_dir), rtol=1e-6)

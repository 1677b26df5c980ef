"""Cornell's text files, written here by their description, and two real ones."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.albedo import directional_albedo
from rsibr.rsibr_addon.core.brdf.spectrum import rec709_from_spectrum
from rsibr.rsibr_addon.core.brdf.ward import Ward
from rsibr.rsibr_addon.core.errors import InputFileError, RsibrWarning
from rsibr.rsibr_addon.files.cornell import read_cornell
from rsibr.tests.measurements import measurement

HEADER = "# Cornell University, Program of Computer Graphics\n\n# num wls\n{count}\n\n# wls\n{wls}\n\n"
WAVELENGTHS = "400 500\n600 700"


def rows(values: list[float]) -> np.ndarray:
    """Samples at a grid of directions, all with the same reflectances."""
    theta, phi = np.meshgrid(np.radians([10.0, 40.0, 70.0]), np.radians([0.0, 60.0, 120.0, 180.0]))
    angles = np.stack([np.full(theta.size, 0.3), np.zeros(theta.size), theta.ravel(), phi.ravel()], axis=1)
    return np.concatenate([angles, np.tile(values, (len(angles), 1))], axis=1)


def write(path: Path, samples: np.ndarray, count: int = 4, wls: str = WAVELENGTHS) -> Path:
    lines = (" ".join(f"{number:.6f}" for number in row) for row in samples)
    path.write_text(HEADER.format(count=count, wls=wls) + "# theta i ...\n" + "\n".join(lines) + "\n")
    return path


def directions(theta: np.ndarray, phi: np.ndarray) -> np.ndarray:
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def test_a_flat_spectrum_is_read_as_grey(tmp_path: Path) -> None:
    samples = rows([0.25] * 4)
    path = write(tmp_path / "grey.brdf", samples)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        brdf = read_cornell(path)
    assert brdf.spec == f"cornell:path={path}"
    found = brdf(directions(*samples.T[:2]), directions(*samples.T[2:4]))
    # Between so few samples a plane through the logarithms is off by some per cent; the hue is exact
    np.testing.assert_allclose(found, 0.25, rtol=0.2)
    np.testing.assert_allclose(found[:, 1:], found[:, :-1], rtol=1e-6)


def test_negative_and_missing_numbers_are_counted_and_floored(tmp_path: Path) -> None:
    samples = rows([0.25] * 4)
    samples[0, 4] = -0.5
    samples[3, 5] = samples[4, 5] = np.nan
    with pytest.warns(RsibrWarning, match="holds 3 reflectances that are negative or NaN"):
        read_cornell(write(tmp_path / "a.brdf", samples))


def test_colours_outside_the_gamut_are_counted_and_floored(tmp_path: Path) -> None:
    with pytest.warns(RsibrWarning, match=r"has \d+ values of colours outside Rec. 709"):
        brdf = read_cornell(write(tmp_path / "a.brdf", rows([0.0, 0.2, 0.0, 0.0])))
    assert brdf.density.table.min() == 0.0
    assert brdf.density.table.max() > 0.01


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("", "no measurement of Cornell's"),
        ("# only a comment\n", "it has no spectra"),
        ("a text of no numbers", "no measurement of Cornell's"),
        ("1\n550\n0.1 0 0.1 0 0.5\n", "no spectra"),
        ("31\n400 500", "no spectra"),
        ("-3 1 2 3", "no spectra"),
        ("1e300 1 2 3", "no measurement of Cornell's"),
        ("nan 1 2 3", "no measurement of Cornell's"),
        ("2\n400 700\n0.1 0 0.1 0 0.5 0.5\n0.1 0 0.1", "ends within a row of 6 numbers"),
        ("2\n700 400\n" + "0.1 0 0.1 0 0.5 0.5\n" * 9, "increasing order"),
        ("2\n400 700\n" + "0.1 0 1.6 0 0.5 0.5\n" * 9, "polar angles"),
        ("2\n400 700\n" + "10 0 45 0 0.5 0.5\n" * 9, "polar angles"),
        ("2\n400 700\n" + "0.1 0 nan 0 0.5 0.5\n" * 9, "polar angles"),
        ("2\n400 700\n" + "0.1 inf 0.1 0 0.5 0.5\n" * 9, "azimuths"),
        ("2\n400 700\n" + "0.1 0 0.1 0 0 0\n" * 99, "more than 8 samples"),
        ("2\n400 700\n" + "0.1 0 0.1 0 0.5 0.5\n" * 8, "more than 8 samples"),
    ],
)
def test_damaged_files_are_refused_in_words(tmp_path: Path, content: str, sentence: str) -> None:
    path = tmp_path / "a.brdf"
    path.write_text(content)
    with pytest.raises(InputFileError, match=sentence) as caught:
        read_cornell(path)
    assert str(path) in str(caught.value)


def test_a_file_of_another_size_altogether_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.brdf"
    with path.open("wb") as stream:
        stream.truncate((1 << 26) + 1)
    with pytest.raises(InputFileError, match="larger than any measurement"):
        read_cornell(path)


def test_a_paint_measured_so_is_itself(tmp_path: Path) -> None:
    paint = Ward(alpha=0.3, ks=0.2, kd=0.15)
    degrees = np.meshgrid([10, 30, 50, 70, 80], range(0, 81, 10), range(0, 181, 15), indexing="ij")
    theta_i, theta_s, phi = np.radians(degrees).reshape(3, -1)
    light_dir, view_dir = directions(theta_i, np.zeros_like(phi)), directions(theta_s, phi)
    expected = paint(light_dir, view_dir)
    # A spectrum that is flat, so that its colour is known
    angles = np.stack([theta_i, np.zeros_like(phi), theta_s, phi], axis=1)
    samples = np.concatenate([angles, np.repeat(expected[:, :1], 4, axis=1)], axis=1)
    brdf = read_cornell(write(tmp_path / "paint.brdf", samples))
    error = np.abs(brdf(light_dir, view_dir) / expected - 1.0)
    assert np.median(error) < 0.01
    # At the border of the samples planes are drawn out, beside the peak at grazing angles above all
    assert np.percentile(error, 95) < 0.2


def measured(name: str) -> tuple[Path, np.ndarray]:
    """A real file, and its samples read the plain way."""
    path = measurement(f"brdf/cornell/{name}.brdf")
    numbers = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return path, np.array(" ".join(numbers).split()[32:], dtype=float).reshape(-1, 35)


@pytest.mark.parametrize(("name", "spread"), [("cayman", 0.08), ("garnet_red", 0.03)])
def test_real_paints_are_close_to_their_samples(name: str, spread: float) -> None:
    path, samples = measured(name)
    with pytest.warns(RsibrWarning, match="colours outside Rec. 709"):
        brdf = read_cornell(path)
    light_dir, view_dir = directions(*samples.T[:2]), directions(*samples.T[2:4])
    mean = np.maximum(rec709_from_spectrum(np.arange(400.0, 701.0, 10.0), samples[:, 4:]), 0.0).mean(axis=1)
    bright = mean > 5e-3  # the instrument's own noise is some 1e-3
    ratio = brdf(light_dir, view_dir).mean(axis=1)[bright] / mean[bright]
    # Planes through eight noisy samples, in a table of 3-degree cells
    assert np.median(np.abs(ratio - 1.0)) < spread
    assert np.percentile(np.abs(ratio - 1.0), 95) < 0.35
    # The peak that one sample caught, at 80 degrees
    peak = np.argmax(mean)
    assert brdf(light_dir[peak], view_dir[peak]).mean() == pytest.approx(mean[peak], rel=0.1)
    albedo = directional_albedo(brdf, [1.0, 0.6, 0.3, 0.1, 0.03])
    assert 0.0 <= albedo.min() < albedo.max() < 1.0
    colour = {"cayman": 2, "garnet_red": 0}[name]
    assert np.argmax(albedo[0]) == colour


@pytest.mark.parametrize(("scale", "unit"), [(1e-3, "micrometres"), (1e-9, "metres")])
def test_wavelengths_in_other_units_are_told_and_read(tmp_path: Path, scale: float, unit: str) -> None:
    values = [0.9, 0.5, 0.2, 0.1]
    expected = read_cornell(write(tmp_path / "a.brdf", rows(values))).density.table
    small = " ".join(f"{scale * wavelength:g}" for wavelength in (400, 500, 600, 700))
    with pytest.warns(RsibrWarning, match=rf"The wavelengths of .* are .* taken for {unit}"):
        found = read_cornell(write(tmp_path / "b.brdf", rows(values), wls=small)).density.table
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_wavelengths_that_no_eye_sees_are_told(tmp_path: Path) -> None:
    with pytest.warns(RsibrWarning, match="1 of the wavelengths of .*, 400 to 900 nm, are not visible"):
        read_cornell(write(tmp_path / "a.brdf", rows([0.25] * 4), wls="400 500 600 900"))
    with pytest.warns(RsibrWarning, match="The wavelengths of .*, 500 to 620 nm, leave out up to"):
        read_cornell(write(tmp_path / "a.brdf", rows([0.25] * 4), wls="500 550 600 620"))
    with pytest.raises(InputFileError, match="wavelengths, 1000 to 1600 nm, are not visible"):
        read_cornell(write(tmp_path / "a.brdf", rows([0.25] * 4), wls="1000 1200 1400 1600"))

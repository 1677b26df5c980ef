"""Fit files: the same values back, and what a damaged file says."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.fit import Fit
from rsibr.rsibr_addon.files.fits import read_fit, write_fit


def some_fit() -> Fit:
    rng = np.random.default_rng(5)
    return Fit(
        brdf="ward:alpha=0.04,ks=0.8",
        method="joint",
        mu=np.array([1.0 / 6.0, 0.5, 5.0 / 6.0]),
        bank=KernelBank((0.5, np.sqrt(2.0), 1e5)),
        weights=rng.normal(size=(2, 3, 3, 3)) * 1e-9,
        scale=rng.normal(size=(2, 3, 3)),
        offsets=rng.normal(size=(2, 3, 4, 2)),
        taps=rng.normal(size=(2, 3, 4)) * 1e9,
    )


def test_a_fit_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    path = tmp_path / "FIT.json"
    fit = some_fit()
    write_fit(path, fit, {"E": 0.1})
    back = read_fit(path)
    assert (back.brdf, back.method, back.bank) == (fit.brdf, fit.method, fit.bank)
    for name in ("mu", "weights", "scale", "offsets", "taps"):
        np.testing.assert_array_equal(getattr(back, name), getattr(fit, name))
    assert json.loads(path.read_text())["report"] == {"E": 0.1}


def test_the_error_of_a_fit_to_captures_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "FIT.json"
    write_fit(path, replace(some_fit(), left_out=0.0125), {})
    assert read_fit(path).left_out == 0.0125
    write_fit(path, some_fit(), {}, force=True)
    assert read_fit(path).left_out is None


def test_a_fit_is_not_replaced_unless_told(tmp_path: Path) -> None:
    path = tmp_path / "FIT.json"
    path.write_text("kept")
    with pytest.raises(OutputFileError, match="--force to replace it"):
        write_fit(path, some_fit(), {})
    assert path.read_text() == "kept"
    write_fit(path, some_fit(), {}, force=True)
    assert read_fit(path).method == "joint"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"kind": "something"}, "is no lobe fit: give a file that rsibr fit wrote"),
        ({"format": 2}, "has format 2, which is newer: update the program"),
        ({"mu": None}, r"is damaged \(mu is not a list\): fit again, or restore the file"),
        ({"mu": [0.5, 0.4, 0.3]}, "is damaged"),
        ({"taps": [1.0]}, "is damaged"),
        ({"weights": [[[["x"]]]]}, "is damaged"),
        ({"weights": [[1.0], [1.0, 2.0]]}, "is damaged"),
        ({"concentrations": [3.0, 2.0, 1.0]}, "is damaged"),
        ({"concentrations": 7}, "is damaged"),
    ],
)
def test_what_is_no_fit_is_told(tmp_path: Path, change: dict[str, object], sentence: str) -> None:
    path = tmp_path / "FIT.json"
    write_fit(path, some_fit(), {})
    path.write_text(json.dumps({**json.loads(path.read_text()), **change}))
    with pytest.raises(InputFileError, match=f"^{path}.*{sentence}"):
        read_fit(path)


def test_a_truncated_or_missing_file_is_told(tmp_path: Path) -> None:
    path = tmp_path / "FIT.json"
    write_fit(path, some_fit(), {})
    path.write_text(path.read_text()[:-100])
    with pytest.raises(InputFileError, match=r"is damaged \(it is not JSON: "):
        read_fit(path)
    with pytest.raises(InputFileError, match="does not exist"):
        read_fit(tmp_path / "other.json")
    (tmp_path / "number.json").write_text("7")
    with pytest.raises(InputFileError, match="is no lobe fit"):
        read_fit(tmp_path / "number.json")

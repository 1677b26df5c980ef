"""What tests of batches start from."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.tests.batches import ENVIRONMENTS


@pytest.fixture
def light_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work beside a folder light, which holds all environments of `tests.batches`."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "light").mkdir()
    for number, name in enumerate(ENVIRONMENTS):
        pixels = np.random.default_rng(number).random((16, 32, 3))
        write_radiance(tmp_path / "light" / f"{name}.exr", pixels)

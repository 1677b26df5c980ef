"""A file is opened once to be read: each time costs, over a network most."""

import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.files.exr import read_parts
from rsibr.rsibr_addon.files.kinds.environment import is_environment
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header
from rsibr.rsibr_addon.files.pictures import describe_exr, read_exr
from rsibr.rsibr_addon.files.radiance_pictures import read_radiance, write_radiance
from rsibr.tests.flat_capture import write_flat_capture


def opens(read: Callable[[Path], Any], path: Path, monkeypatch: pytest.MonkeyPatch) -> int:
    """How often a function opens a file."""
    seen, really_open = [], io.open

    def noted(file: Any, *arguments: Any, **options: Any) -> Any:
        seen.append(file)
        return really_open(file, *arguments, **options)

    with monkeypatch.context() as patched:
        patched.setattr(io, "open", noted)  # what `Path.open` calls
        read(path)
    return seen.count(path)


@pytest.mark.parametrize("read", [read_parts, is_environment, read_map_set, read_map_set_header])
def test_a_map_set(read: Callable[[Path], Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert opens(read, write_flat_capture(tmp_path / "a.rsibr.exr", (0.5, 0.5, 0.5)), monkeypatch) == 1


def test_a_path_through_a_file_does_not_exist(tmp_path: Path) -> None:
    (tmp_path / "a.exr").touch()
    with pytest.raises(InputFileError, match=r"a\.exr/b\.exr does not exist: check the name and the folder"):
        read_radiance(tmp_path / "a.exr" / "b.exr")


@pytest.mark.skipif(os.name == "nt", reason="Windows takes both signs")
def test_a_path_of_windows_is_answered_with_the_file_that_is_meant(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("light").mkdir()
    Path("light/a.exr").touch()
    with pytest.raises(
        InputFileError, match=r"^light\\a\.exr does not exist, but light/a\.exr does: write / "
    ):
        read_radiance("light\\a.exr")
    with pytest.raises(InputFileError, match=r"b\.exr does not exist: check the name and the folder"):
        read_radiance("light\\b.exr")


@pytest.mark.parametrize("read", [read_parts, read_exr, read_radiance, describe_exr])
def test_a_picture(read: Callable[[Path], Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_radiance(tmp_path / "a.exr", np.ones((2, 4, 3)))
    assert opens(read, tmp_path / "a.exr", monkeypatch) == 1

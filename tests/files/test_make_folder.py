"""Folders for outputs."""

import errno
from pathlib import Path
from typing import Any

import pytest
from rsibr.rsibr_addon.core.errors import NotNowError, OutputFileError
from rsibr.rsibr_addon.files.outputs import made_folders, make_folder


def test_a_folder_is_made_with_those_around_it_and_may_be_there(tmp_path: Path) -> None:
    for _ in range(2):
        make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()


def test_a_file_of_its_name_stays_and_is_told(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("mine")
    with pytest.raises(OutputFileError, match="a was not made") as told:
        make_folder(tmp_path / "a")
    assert not isinstance(told.value, NotNowError)
    assert (tmp_path / "a").read_text() == "mine"


def test_a_full_disk_may_pass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*asked: Any, **more: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "mkdir", full)
    with pytest.raises(NotNowError, match="a was not made because the disk is full: free"):
        make_folder(tmp_path / "a")


def test_what_fails_leaves_no_empty_folder_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()

    def fail() -> None:
        with made_folders(tmp_path / "mine" / "a" / "b", tmp_path / "c"):
            (tmp_path / "c" / "some.txt").touch()
            raise ValueError("late")

    with pytest.raises(ValueError, match="late"):
        fail()
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["c", "mine", "some.txt"]

"""Temporary files: gone afterwards, and a full disk is called that."""

import errno
import os
import tempfile
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError
from rsibr.rsibr_addon.files.staging import staging_folder
from rsibr.rsibr_addon.files.temporary import temporary_folder

FULL = r"The disk with the temporary files is full \({}\): free some space there, or set TMPDIR"


@pytest.fixture(autouse=True)
def _own_temporary_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def read_half() -> None:
    """Read what has come out short, whatever was in its way."""
    with temporary_folder() as folder:
        (folder / "picture.exr").write_text("half")
        raise InputFileError("picture.exr is truncated: make it again.")


def test_it_is_gone_afterwards(tmp_path: Path) -> None:
    with temporary_folder() as folder:
        (folder / "a").touch()
        assert folder.parent == tmp_path
    assert list(tmp_path.iterdir()) == []


def test_what_a_full_disk_truncates_is_called_that(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(InputFileError, match="truncated"):
        read_half()

    def refuse(descriptor: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", refuse)
    with staging_folder(tmp_path) as of_a_command:
        monkeypatch.setattr(tempfile, "tempdir", str(of_a_command))
        with pytest.raises(OutputFileError, match=FULL.format(tmp_path)):
            read_half()
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_takes_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "absent"))
    with pytest.raises(OutputFileError, match=r"No temporary files can be written \(No such file"):
        read_half()

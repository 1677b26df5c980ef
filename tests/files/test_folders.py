"""Folders of results: whole or not at all, and nobody else's folder is ever replaced."""

from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.files.folders import check_folder_target, folder_written_aside

MARKER = "result.json"


def fill(path: Path, text: str, force: bool = False) -> None:
    with folder_written_aside(path, MARKER, force) as aside:
        (aside / "pictures").mkdir()
        (aside / "pictures" / "a.txt").write_text(text)
        (aside / MARKER).write_text(text)


def contents(folder: Path) -> dict[str, str]:
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


def test_a_folder_appears_whole(tmp_path: Path) -> None:
    fill(tmp_path / "out", "1")
    assert contents(tmp_path) == {"out/result.json": "1", "out/pictures/a.txt": "1"}


def test_an_empty_folder_is_filled(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    fill(tmp_path / "out", "1")
    assert contents(tmp_path) == {"out/result.json": "1", "out/pictures/a.txt": "1"}


def test_a_result_is_replaced_only_by_force(tmp_path: Path) -> None:
    fill(tmp_path / "out", "1")
    (tmp_path / "out" / "old").write_text("1")
    with pytest.raises(OutputFileError, match="out exists: give another name, or --force"):
        fill(tmp_path / "out", "2")
    fill(tmp_path / "out", "2", force=True)
    assert contents(tmp_path) == {"out/result.json": "2", "out/pictures/a.txt": "2"}


def test_another_folder_is_never_replaced(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("all of it")
    with pytest.raises(OutputFileError, match="holds other things: give the name of a new folder"):
        fill(tmp_path / "out", "1", force=True)
    assert contents(tmp_path) == {"out/thesis.txt": "all of it"}


def test_nothing_is_left_of_a_failure(tmp_path: Path) -> None:
    fill(tmp_path / "out", "1")
    with pytest.raises(KeyError, match="gone"), folder_written_aside(tmp_path / "out", MARKER, True) as aside:
        (aside / MARKER).write_text({}["gone"])
    assert contents(tmp_path) == {"out/result.json": "1", "out/pictures/a.txt": "1"}


def test_what_the_system_refuses_is_said(tmp_path: Path) -> None:
    with (
        pytest.raises(OutputFileError, match=r"out was not written because the disk is full"),
        folder_written_aside(tmp_path / "out", MARKER),
    ):
        raise OSError(28, "No space left on device")
    assert not list(tmp_path.iterdir())


def test_impossible_names_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(OutputFileError, match="is a file: give the name of a folder"):
        check_folder_target(tmp_path / "file", MARKER)
    with pytest.raises(OutputFileError, match="does not exist, so out cannot be written"):
        check_folder_target(tmp_path / "absent" / "out", MARKER)

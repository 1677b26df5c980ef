"""The work folder: for one process and one work, and gone when that is done."""

import contextlib
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError, RsibrWarning
from rsibr.rsibr_addon.files.staging import staging_name
from rsibr.rsibr_addon.files.work_folder import held_work_folder, kept_parts, work_folder_beside


class Interruption(Exception):  # noqa: N818
    """Whatever ends work early."""


@contextlib.contextmanager
def work_folder(path: Path, work: dict[str, object]) -> Iterator[Path]:
    with held_work_folder(path), kept_parts(path, work):
        yield path


def work_and_stop(path: Path, work: dict[str, object], *parts: str) -> None:
    with work_folder(path, work) as folder:
        for part in parts:
            (folder / part).write_text(part)
        raise Interruption


def names(path: Path) -> set[str]:
    return {item.name for item in path.iterdir()} - {"rsibr.lock", "job.json"}


def test_it_is_there_for_the_work_and_then_gone(tmp_path: Path) -> None:
    path = tmp_path / "work"
    with work_folder(path, {"n": 1}) as folder:
        assert folder == path
        assert path.is_dir()
        (folder / "part").write_text("half")
    assert not path.exists()


def test_what_is_done_stays_after_an_interruption(tmp_path: Path) -> None:
    path = tmp_path / "work"
    with pytest.raises(Interruption):
        work_and_stop(path, {"n": 1}, "a", "b")
    with work_folder(path, {"n": 1}) as folder:
        assert names(folder) == {"a", "b"}
    assert not path.exists()


def test_without_anything_done_it_goes_after_an_interruption_too(tmp_path: Path) -> None:
    with pytest.raises(Interruption):
        work_and_stop(tmp_path / "work", {"n": 1})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("text", [None, "", "[", json.dumps({"n": 2})])
def test_parts_of_other_or_unknown_work_are_removed_with_a_word(tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "work"
    with pytest.raises(Interruption):
        work_and_stop(path, {"n": 1}, "a")
    if text is None:
        (path / "job.json").unlink()
    else:
        (path / "job.json").write_text(text)
    with pytest.warns(RsibrWarning, match="held parts of another job"), pytest.raises(Interruption):
        work_and_stop(path, {"n": 1}, "b")
    assert names(path) == {"b"}
    assert json.loads((path / "job.json").read_text()) == {"n": 1}


def test_nobody_else_gets_in(tmp_path: Path) -> None:
    path = tmp_path / "work"
    script = (
        "import sys\n"
        "from rsibr.rsibr_addon.files.work_folder import held_work_folder\n"
        "with held_work_folder(__import__('pathlib').Path(sys.argv[1])):\n"
        "    print('in', flush=True)\n"
        "    sys.stdin.read()\n"
    )
    command = [sys.executable, "-c", script, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "in\n"
        with pytest.raises(BlockingIOError), held_work_folder(path):
            pass
        assert path.is_dir()
        other.kill()
    # The lock of a dead process holds nobody up.
    with work_folder(path, {"n": 1}):
        pass
    assert not path.exists()


def test_what_is_not_ours_stays(tmp_path: Path) -> None:
    file, folder = tmp_path / "file", tmp_path / "folder"
    file.write_text("precious")
    folder.mkdir()
    (folder / "thesis.txt").write_text("precious")
    (folder / "lock").touch()
    (folder / "job.json").touch()
    with pytest.raises(OutputFileError, match="cannot be made"), work_folder(file, {}):
        pass
    with pytest.raises(OutputFileError, match="holds files other than"), work_folder(folder, {}):
        pass
    assert file.read_text() == (folder / "thesis.txt").read_text() == "precious"


def test_what_a_killed_process_was_writing_in_it_goes(tmp_path: Path) -> None:
    path = tmp_path / "work"
    with pytest.raises(Interruption):
        work_and_stop(path, {"n": 1}, "a")
    stray = path / staging_name()
    stray.mkdir()
    (stray / "a.exr").touch()
    with work_folder(path, {"n": 1}) as folder:
        assert names(folder) == {"a"}


def test_its_name_tells_the_files_where_that_is_short_enough(tmp_path: Path) -> None:
    assert work_folder_beside(tmp_path / "a.exr") == tmp_path / "a.exr.partial"
    longest = tmp_path / (251 * "a" + ".exr")
    path = work_folder_beside(longest)
    assert path != work_folder_beside(longest.with_stem(251 * "b"))
    with work_folder(path, {}) as folder:
        assert folder.parent == tmp_path

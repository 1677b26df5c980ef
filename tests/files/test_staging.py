"""What killed processes left goes, and nothing else does."""

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.files import locks, staging
from rsibr.rsibr_addon.files.atomic import check_target, written_aside
from rsibr.rsibr_addon.files.folders import check_folder_target, folder_written_aside
from rsibr.rsibr_addon.files.locks import LOCK, held
from rsibr.rsibr_addon.files.staging import (
    REPLACED,
    clear_strays,
    remove_own,
    staging_folder,
    staging_name,
)

HOLDER = """
import sys, time
from pathlib import Path
from rsibr.rsibr_addon.files.atomic import written_aside
with written_aside(sys.argv[1]) as aside:
    aside.write_text("half")
    print("written", flush=True)
    time.sleep(100)
"""


def start_writing(target: Path) -> subprocess.Popen[str]:
    writer = subprocess.Popen([sys.executable, "-c", HOLDER, target], stdout=subprocess.PIPE, text=True)
    assert writer.stdout is not None
    assert writer.stdout.readline() == "written\n"
    return writer


def test_what_a_killed_process_left_goes_and_what_a_living_one_writes_stays(tmp_path: Path) -> None:
    with start_writing(tmp_path / "a.exr") as living:
        with start_writing(tmp_path / "b.exr") as killed:
            killed.kill()
        assert len(os.listdir(tmp_path)) == 2
        with written_aside(tmp_path / "c.exr") as aside:
            aside.touch()
        (left,) = set(os.listdir(tmp_path)) - {"c.exr"}
        assert (tmp_path / left / "a.exr").read_text() == "half"
        living.kill()
    check_target(tmp_path / "a.exr")
    assert os.listdir(tmp_path) == ["c.exr"]


def test_a_folder_whose_process_died_before_it_could_hold_it_goes(tmp_path: Path) -> None:
    (tmp_path / staging_name()).mkdir()
    check_folder_target(tmp_path / "out", "result.json")
    assert os.listdir(tmp_path) == []


WORKER = """
import sys, time
from pathlib import Path
from rsibr.rsibr_addon.files.work_folder import held_work_folder
with held_work_folder(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(100)
"""


def test_the_empty_work_folder_of_a_killed_process_goes_and_a_living_one_s_stays(tmp_path: Path) -> None:
    folders = [tmp_path / f"{name}.rsibr.exr.partial" for name in ("killed", "living")]
    workers = [
        subprocess.Popen([sys.executable, "-c", WORKER, folder], stdout=subprocess.PIPE, text=True)
        for folder in folders
    ]
    with workers[0] as killed, workers[1] as living:
        for worker in workers:
            assert worker.stdout is not None
            assert worker.stdout.readline() == "held\n"
        killed.kill()
        killed.wait()
        for name, held_file in (("parts", LOCK), ("theirs", "notes.txt")):
            (tmp_path / f"{name}.partial").mkdir()
            (tmp_path / f"{name}.partial" / held_file).touch()
        (tmp_path / "parts.partial" / "view_000.exr").touch()
        with written_aside(tmp_path / "other.exr") as aside:
            aside.touch()
        assert set(os.listdir(tmp_path)) == {
            "living.rsibr.exr.partial",
            "parts.partial",
            "theirs.partial",
            "other.exr",
        }
        living.kill()


def test_another_machines_goes_after_a_day(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(socket, "gethostname", lambda: "another machine")
        stray = tmp_path / staging_name()
    stray.mkdir()
    clear_strays(tmp_path)
    assert stray.is_dir()
    yesterday = time.time() - 25 * 3600
    os.utime(stray, (yesterday, yesterday))
    clear_strays(tmp_path)
    assert os.listdir(tmp_path) == []


def test_what_is_not_ours_stays(tmp_path: Path) -> None:
    precious, name = tmp_path / "precious", staging_name()
    for folder in (precious, tmp_path / ".rsibr-notes", tmp_path / f"{name}.old"):
        folder.mkdir()
        (folder / "thesis.txt").touch()
    (tmp_path / staging_name()).symlink_to(precious)
    (tmp_path / staging_name()).touch()
    before = sorted(tmp_path.rglob("*"))
    clear_strays(tmp_path)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_kill_while_a_folder_takes_anothers_place_loses_neither(tmp_path: Path) -> None:
    out = tmp_path / "out"
    script = """
import os, sys
from pathlib import Path
from rsibr.rsibr_addon.files.folders import folder_written_aside
rename, path = Path.rename, Path(sys.argv[1])
def killed_after(self, target):
    rename(self, target)
    if not path.exists():
        os.kill(os.getpid(), 9)
Path.rename = killed_after
with folder_written_aside(path, "result.json", force=True) as aside:
    (aside / "result.json").write_text("new")
"""
    with folder_written_aside(out, "result.json") as aside:
        (aside / "result.json").write_text("old")
    assert subprocess.run([sys.executable, "-c", script, out], check=False).returncode == -9
    assert not out.exists()
    check_folder_target(out, "result.json", force=True)
    assert [(path.name, path.read_text()) for path in tmp_path.rglob("*.*")] == [("result.json", "old")]


def test_a_folder_is_made_anew_when_it_is_taken_for_a_stray(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mkdir = Path.mkdir

    def made_and_taken(path: Path, mode: int = 0o777, exist_ok: bool = False) -> None:
        mkdir(path, mode, exist_ok=exist_ok)
        monkeypatch.setattr(Path, "mkdir", mkdir)
        clear_strays(tmp_path)
        assert not path.exists()

    monkeypatch.setattr(Path, "mkdir", made_and_taken)
    with staging_folder(tmp_path) as folder:
        assert folder.is_dir()
    assert os.listdir(tmp_path) == []


def test_blenders_folder_goes_where_a_killed_command_held_it(tmp_path: Path) -> None:
    ours, others, living = (tmp_path / f"blender_{name}" for name in ("aB3x_1", "others", "living"))
    for folder in (ours, others):
        folder.mkdir()
        (folder / "picture.png").touch()
    (ours / LOCK).touch()
    with held(living):
        clear_strays(tmp_path)
        assert sorted(tmp_path.iterdir()) == [living, others]


def test_a_process_that_is_told_to_end_takes_its_own_with_it(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with staging_folder(tmp_path) as folder, staging_folder(tmp_path) as other:
        (other / "a").touch()
        (folder / REPLACED).mkdir()
        out.mkdir()
        out.rename(folder / REPLACED / "out")
        remove_own()
        assert list(tmp_path.iterdir()) == [out]


def test_held_folders_go_with_a_process_that_is_told_to_end_but_for_what_is_finished(tmp_path: Path) -> None:
    with held(tmp_path / "empty"), held(tmp_path / "kept"):
        (tmp_path / "kept" / "part").touch()
        remove_own()
        assert {each.name for each in tmp_path.rglob("*")} == {"kept", LOCK, "part"}


def test_a_file_system_that_does_not_show_what_it_made_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "folder"
    monkeypatch.setattr(locks, "_is_there", lambda path, file: False)
    with pytest.raises(OSError, match=f"does not show what was made.*{LOCK}"), held(folder):
        pass
    monkeypatch.undo()
    # A link to nothing in a folder that is not there is made anew each time, and never found
    (folder / LOCK).unlink()
    (folder / LOCK).symlink_to(tmp_path / "none" / "none")
    with pytest.raises(OSError, match=f"does not show what was made.*{LOCK}"), held(folder):
        pass


def test_what_an_older_version_left_goes_after_a_day(tmp_path: Path) -> None:
    out = tmp_path / "out.rsibr.exr"
    stray, young = tmp_path / ".out.rsibr.0123abcd.exr", tmp_path / ".out.rsibr.89abcdef.exr"
    others = [
        tmp_path / name for name in (".other.0123abcd.exr", ".out.rsibr.0123abcd.hdr", ".out.rsibr.exr")
    ]
    for path in (stray, young, *others):
        path.touch()
    yesterday = time.time() - 25 * 3600
    for path in (stray, *others):
        os.utime(path, (yesterday, yesterday))
    check_target(out)
    assert sorted(tmp_path.iterdir()) == sorted([young, *others])


def test_folders_that_others_hold_each_time_are_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(folder: Path) -> None:
        raise BlockingIOError

    monkeypatch.setattr(staging, "held", refused)
    with (
        pytest.raises(OutputFileError, match="other processes hold each new folder"),
        written_aside(tmp_path / "a.exr"),
    ):
        pass

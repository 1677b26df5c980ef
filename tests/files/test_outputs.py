"""Outputs of one command: all of them or none, and nobody's mode, owner or protection is lost."""

import errno
import os
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import OutputFileError
from rsibr.rsibr_addon.files.atomic import check_target, written_aside
from rsibr.rsibr_addon.files.folders import check_folder_target, folder_written_aside
from rsibr.rsibr_addon.files.outputs import together

MARKER = "result.json"

superuser = pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() != 0, reason="files of others take a superuser to make"
)


def write(path: Path, text: str, force: bool = False) -> None:
    with written_aside(path, force) as aside:
        aside.write_text(text)


def fill(path: Path, text: str, force: bool = False) -> None:
    with folder_written_aside(path, MARKER, force) as aside:
        (aside / MARKER).write_text(text)


def contents(folder: Path) -> dict[str, str]:
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


def test_they_appear_when_the_last_is_written(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    with together():
        write(tmp_path / "a", "1")
        fill(tmp_path / "other" / "plots", "2")
        assert not (tmp_path / "a").exists()
    assert contents(tmp_path) == {"a": "1", "other/plots/result.json": "2"}


@pytest.mark.parametrize("force", [False, True])
def test_none_appears_when_one_fails(tmp_path: Path, force: bool) -> None:
    if force:
        write(tmp_path / "a", "old")
    before = contents(tmp_path)

    def fail() -> None:
        with together():
            write(tmp_path / "a", "new", force)
            with written_aside(tmp_path / "b"):
                raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(OutputFileError, match="b was not written because the disk is full"):
        fail()
    assert contents(tmp_path) == before


def test_none_appears_when_one_appeared_meanwhile(tmp_path: Path) -> None:
    def write_late() -> None:
        with together():
            write(tmp_path / "a", "ours")
            write(tmp_path / "b", "ours")
            (tmp_path / "b").write_text("theirs")

    with pytest.raises(OutputFileError, match="b exists"):
        write_late()
    assert contents(tmp_path) == {"b": "theirs"}


@pytest.mark.parametrize("name", ["all", "all/page"])
def test_none_appears_where_one_would_replace_another(tmp_path: Path, name: str) -> None:
    (tmp_path / "link").symlink_to(tmp_path)
    if name != "all":
        fill(tmp_path / "all", "old")
    before = contents(tmp_path)

    def write_both() -> None:
        with together():
            fill(tmp_path / "all", "new", force=True)
            write(tmp_path / "link" / name, "page")

    with pytest.raises(OutputFileError, match="would be replaced by"):
        write_both()
    assert contents(tmp_path) == before


@pytest.mark.parametrize("links", [True, False])
def test_all_is_as_before_when_the_last_cannot_get_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, links: bool
) -> None:
    write(tmp_path / "old", "old")
    fill(tmp_path / "plots", "old")
    before = contents(tmp_path)
    rename = Path.rename

    def refuse(path: Path, target: Path) -> Path:
        if target.name == "last":
            raise OSError(errno.EIO, "Input/output error", str(path))
        return rename(path, target)

    def no_links(path: Path, target: Path) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    def write_all() -> None:
        with together():
            write(tmp_path / "old", "new", force=True)
            write(tmp_path / "new", "new")
            fill(tmp_path / "plots", "new", force=True)
            fill(tmp_path / "more", "new")
            write(tmp_path / "last", "new")

    monkeypatch.setattr(Path, "rename", refuse)
    if not links:
        monkeypatch.setattr(Path, "hardlink_to", no_links)
    with pytest.raises(OutputFileError, match=r"last was not written \(Input/output error\)"):
        write_all()
    assert contents(tmp_path) == before


def test_what_is_replaced_leaves_its_mode(tmp_path: Path) -> None:
    file, folder = tmp_path / "file", tmp_path / "folder"
    write(file, "old")
    fill(folder, "old")
    file.chmod(0o604)
    folder.chmod(0o750)
    write(file, "new", force=True)
    fill(folder, "new", force=True)
    assert stat.S_IMODE(file.stat().st_mode) == 0o604
    assert stat.S_IMODE(folder.stat().st_mode) == 0o750
    assert contents(tmp_path) == {"file": "new", "folder/result.json": "new"}


@superuser
def test_what_is_replaced_leaves_its_owner(tmp_path: Path) -> None:
    path = tmp_path / "file"
    write(path, "old")
    os.chown(path, 12345, 23456)
    path.chmod(0o640)
    write(path, "new", force=True)
    status = path.stat()
    assert (status.st_uid, status.st_gid, stat.S_IMODE(status.st_mode)) == (12345, 23456, 0o640)


def test_what_is_read_only_is_not_replaced(tmp_path: Path) -> None:
    file, folder, link = tmp_path / "file", tmp_path / "folder", tmp_path / "link"
    write(file, "old")
    fill(folder, "old")
    link.symlink_to(file)
    file.chmod(0o444)
    folder.chmod(0o555)
    for path in (file, link):
        with pytest.raises(OutputFileError, match=f"{path.name} is read-only: change its permissions"):
            check_target(path, force=True)
    with pytest.raises(OutputFileError, match="folder is read-only: change its permissions"):
        check_folder_target(folder, MARKER, force=True)
    folder.chmod(0o755)


@pytest.fixture
def public_folder() -> Iterator[Path]:
    """A folder that any user may look into, but only this one may write to."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder).chmod(0o755)
        yield Path(folder)


def as_nobody(path: Path) -> str:
    """What `check_target` says to a user without rights."""
    script = (
        "import os, sys\n"
        "from rsibr.rsibr_addon.core.errors import OutputFileError\n"
        "from rsibr.rsibr_addon.files.atomic import check_target\n"
        "os.setgroups([]), os.setgid(65534), os.setuid(65534)\n"
        "try:\n"
        "    check_target(sys.argv[1], force=True)\n"
        "except OutputFileError as error:\n"
        "    print(error)\n"
    )
    return subprocess.run(
        [sys.executable, "-c", script, path], capture_output=True, text=True, check=True
    ).stdout


@superuser
def test_what_an_unprivileged_user_cannot_write(public_folder: Path) -> None:
    closed, open_to_all = public_folder / "closed", public_folder / "open"
    closed.mkdir(mode=0o700)
    open_to_all.mkdir()
    open_to_all.chmod(0o777)
    (open_to_all / "others").touch(0o644)
    cannot = "cannot be written to: change its permissions, or write elsewhere.\n"
    assert as_nobody(public_folder / "a.exr") == f"{public_folder} {cannot}"
    assert as_nobody(closed / "a.exr") == f"{closed} {cannot}"
    assert as_nobody(closed / "deeper" / "a.exr") == f"{closed / 'deeper'} {cannot}"
    assert "others is read-only: change its permissions" in as_nobody(open_to_all / "others")
    assert as_nobody(open_to_all / "a.exr") == ""

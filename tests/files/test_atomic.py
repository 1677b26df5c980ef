"""Files appear whole or not at all, and never over another one unasked."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import InputFileError, OutputFileError
from rsibr.rsibr_addon.files.atomic import check_target, write_changed, written_aside


def test_the_file_appears_when_the_body_ends(tmp_path: Path) -> None:
    target = tmp_path / "a b.rsibr.exr"
    with written_aside(target) as aside:
        assert aside.parent.parent == tmp_path
        assert aside.suffix == ".exr"
        aside.write_bytes(b"whole")
        assert not target.exists()
    assert target.read_bytes() == b"whole"
    assert os.listdir(tmp_path) == [target.name]


def test_an_error_in_the_body_leaves_nothing(tmp_path: Path) -> None:
    def fail() -> None:
        with written_aside(tmp_path / "a.exr") as aside:
            aside.write_bytes(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert os.listdir(tmp_path) == []


def test_an_error_while_replacing_leaves_the_old_file(tmp_path: Path) -> None:
    target = tmp_path / "a.exr"
    target.write_bytes(b"old")

    def fail() -> None:
        with written_aside(target, force=True) as aside:
            aside.write_bytes(b"half")
            raise InputFileError("something else is wrong")

    with pytest.raises(InputFileError, match="something else"):
        fail()
    assert target.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["a.exr"]


def test_an_existing_file_is_replaced_only_by_force(tmp_path: Path) -> None:
    target = tmp_path / "a.exr"
    target.write_bytes(b"old")
    with pytest.raises(OutputFileError, match=r"a\.exr exists: .*--force"), written_aside(target):
        pytest.fail("the body must not run")
    with written_aside(target, force=True) as aside:
        aside.write_bytes(b"new")
    assert target.read_bytes() == b"new"


def test_a_text_that_is_there_already_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "a.html"
    write_changed(path, "old")
    first = path.stat().st_ino
    write_changed(path, "old")
    assert path.stat().st_ino == first
    write_changed(path, "n\u00e9w \udcff")
    assert path.read_bytes() == "n\u00e9w ?".encode()


def test_a_file_that_appeared_meanwhile_is_kept(tmp_path: Path) -> None:
    target = tmp_path / "a.exr"

    def write() -> None:
        with written_aside(target) as aside:
            aside.write_bytes(b"ours")
            target.write_bytes(b"theirs")

    with pytest.raises(OutputFileError, match="exists"):
        write()
    assert target.read_bytes() == b"theirs"
    assert os.listdir(tmp_path) == ["a.exr"]


def test_a_link_stays_and_what_it_points_to_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    real, link = tmp_path / "disk" / "real.exr", tmp_path / "link.exr"
    real.write_bytes(b"old")
    link.symlink_to(real)
    with written_aside(link, force=True) as aside:
        aside.write_bytes(b"new")
    assert link.is_symlink()
    assert real.read_bytes() == b"new"


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("missing/a.exr", r"missing does not exist, so a\.exr cannot be written"),
        ("missing/deeper/a.exr", r"missing/deeper does not exist, so a\.exr cannot be written"),
        ("file/a.exr", r"file is a file, so a\.exr cannot be in it"),
        ("file/deeper/a.exr", r"file/deeper does not exist, so a\.exr cannot be written"),
        ("folder", r"folder is a folder"),
        ("loop", r"loop cannot be a file's name \(Too many levels of symbolic links\)"),
        ("loop/a.exr", r"loop/a\.exr cannot be a file's name \(Too many levels of symbolic links\)"),
        (252 * "a" + ".exr", r"a\.exr cannot be a file's name \(File name too long\)"),
        (126 * "ä" + ".exr", r"ä\.exr cannot be a file's name \(File name too long\)"),
        (16 * (255 * "a" + "/") + "a.exr", r"a\.exr cannot be a file's name \(File name too long\)"),
        ("a\0b.exr", r"a\\x00b\.exr' cannot be a file's name: give one of letters in UTF-8"),
        ("a\udcff.exr", r"a\\udcff\.exr' cannot be a file's name: give one of letters in UTF-8"),
    ],
)
def test_impossible_targets_are_refused(tmp_path: Path, name: str, sentence: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(OutputFileError, match=sentence):
        check_target(tmp_path / name, force=True)


@pytest.mark.skipif(not Path("/dev/null").is_char_device(), reason="this system has no /dev/null")
def test_a_device_is_never_replaced() -> None:
    with pytest.raises(OutputFileError, match="/dev/null is a device"):
        check_target("/dev/null", force=True)


def test_a_folder_without_write_permission_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Permissions do not bind a superuser, so the system's answer is put in its mouth
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(OutputFileError, match="cannot be written to: change its permissions"):
        check_target(tmp_path / "a.exr")


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EDQUOT])
def test_a_disk_that_fills_up_while_syncing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    def refuse(descriptor: int) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", refuse)
    with (
        pytest.raises(OutputFileError, match=r"a\.exr was not written because the disk is full"),
        written_aside(tmp_path / "a.exr") as aside,
    ):
        aside.write_bytes(b"whole")
    assert os.listdir(tmp_path) == []


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="this system has no /dev/full")
def test_a_disk_that_fills_up_while_writing(tmp_path: Path) -> None:
    def write() -> None:
        with written_aside(tmp_path / "a.exr") as aside:
            aside.symlink_to("/dev/full")
            aside.write_bytes(b"whole")

    with pytest.raises(OutputFileError, match=r"a\.exr was not written because the disk is full"):
        write()
    assert os.listdir(tmp_path) == []


def test_a_body_that_writes_nothing(tmp_path: Path) -> None:
    with pytest.raises(OutputFileError, match=r"a\.exr was not written"), written_aside(tmp_path / "a.exr"):
        pass


def test_what_the_body_cannot_read_is_not_called_an_output_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError), written_aside(tmp_path / "a.exr"):
        (tmp_path / "source").read_bytes()
    assert os.listdir(tmp_path) == []


WRITER = """
import sys
from rsibr.rsibr_addon.files.atomic import written_aside
for turn in range(50):
    with written_aside(sys.argv[1], force=True) as aside, aside.open("wb") as stream:
        for _ in range(8):
            stream.write(sys.argv[2].encode() * 10000)
            stream.flush()
"""


def test_concurrent_writers_leave_one_whole_file(tmp_path: Path) -> None:
    target = tmp_path / "a.exr"
    writers = [subprocess.Popen([sys.executable, "-c", WRITER, target, letter]) for letter in "abc"]
    seen = set()
    while any(writer.poll() is None for writer in writers):
        if target.exists():
            seen.add(target.read_bytes())
    assert [writer.returncode for writer in writers] == [0, 0, 0]
    seen.add(target.read_bytes())
    assert seen <= {letter * 80000 for letter in (b"a", b"b", b"c")}
    assert os.listdir(tmp_path) == ["a.exr"]

"""What Blender and the driver say is not on a terminal, unless it is asked for."""

from pathlib import Path

import pytest
from rsibr.tests.faults.processes import run
from rsibr.tests.mirror_capture import write_mirror_capture

pytestmark = [pytest.mark.needs("gl", "bpy"), pytest.mark.slow]

PREVIEW = ("preview", "../in.rsibr.exr", "--size", "16", "--turntable", "2", "-o", "out.png")


def test_a_preview_says_what_it_made_and_keeps_the_rest_in_a_log(tmp_path: Path) -> None:
    write_mirror_capture(tmp_path / "in.rsibr.exr")
    ended = run(tmp_path, *PREVIEW)
    assert (ended.code, ended.out, ended.err) == (0, "out.png\nout.mp4\n", "")
    logged = run(tmp_path, *PREVIEW, "--force", "--log", "log.txt")
    assert (logged.code, logged.out, logged.err) == (0, "out.png\nout.mp4\n", "")
    verbose = run(tmp_path, *PREVIEW, "--force", "--verbose")
    assert (verbose.code, verbose.out) == (0, "out.png\nout.mp4\n")
    # What exactly they say is theirs; of a movie, Blender says something everywhere
    assert verbose.err
    assert (tmp_path / "work" / "log.txt").read_text()


def test_a_log_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    ended = run(tmp_path, "info", "in.exr", "--log", "missing/log.txt")
    assert ended.code == 1
    assert ended.err == (
        "rsibr: error: missing/log.txt cannot be used (No such file or directory): check what is there, or "
        "give another.\n"
    )

"""Hashes of files, which are read again only after they have changed."""

import hashlib
import os
from pathlib import Path

import pytest
from rsibr.rsibr_addon.files.digests import digest


def test_many_files_are_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = [tmp_path / str(number) for number in range(100)]
    for path in paths:
        path.write_text(path.name)
    told = [digest(path) for path in paths]
    assert told == [hashlib.sha256(path.name.encode()).hexdigest() for path in paths]
    with monkeypatch.context() as patched:
        patched.delattr(hashlib, "file_digest")
        assert [digest(path) for path in paths] == told
    paths[0].write_text("changed")
    os.utime(paths[0], (1, 1))
    assert digest(paths[0]) == hashlib.sha256(b"changed").hexdigest()

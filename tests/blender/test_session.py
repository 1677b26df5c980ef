"""What the running extension keeps in memory has a beginning and an end."""

import threading
from itertools import repeat

import pytest
from rsibr.rsibr_addon.session.running import begun_session, session


def workers() -> int:
    return sum(thread.name == "rsibr worker" for thread in threading.enumerate())


def test_what_a_session_does_ends_with_it() -> None:
    with begun_session(has_windows=False) as begun:
        assert session() is begun
        assert workers() == 0
        begun.worker.request("endless", repeat(False), is_urgent=True)
        assert workers() == 1
        with begun_session(has_windows=False) as inner:
            assert session() is inner
            assert inner.previews is not begun.previews
        assert session() is begun
    assert workers() == 0
    assert not begun.worker.is_busy
    with pytest.raises(IndexError):
        session()

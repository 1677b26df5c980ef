"""Warnings that are told, and such that are kept."""

import threading

import pytest
from rsibr.rsibr_addon.core.errors import RsibrWarning
from rsibr.rsibr_addon.core.warned import recorded_warnings, warn


def test_a_thread_hears_its_own_warnings_and_waits_for_no_other() -> None:
    listening, heard = threading.Event(), threading.Event()
    kept: list[str] = []

    def work() -> None:
        with recorded_warnings() as sentences:
            listening.set()
            assert heard.wait(60)
            warn("Of the thread.")
        kept.extend(sentences)

    thread = threading.Thread(target=work)
    thread.start()
    assert listening.wait(60)
    with recorded_warnings() as sentences:
        warn("Of this one.")
    heard.set()
    thread.join()
    assert (sentences, kept) == (["Of this one."], ["Of the thread."])


def test_the_innermost_recorder_keeps_a_warning() -> None:
    with recorded_warnings() as outer:
        with recorded_warnings() as inner:
            warn("One.")
        warn("Two.")
    assert (outer, inner) == (["Two."], ["One."])
    with pytest.warns(RsibrWarning, match="Three."):
        warn("Three.")

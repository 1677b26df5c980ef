"""What libraries print is dropped; what others print meanwhile is not."""

import os
import sys
import threading

import pytest
from rsibr.rsibr_addon.files.unheard import unheard


def test_the_own_thread_is_not_heard(capfd: pytest.CaptureFixture[str]) -> None:
    with unheard():
        sys.stdout.write("from a library\n")
        os.write(2, b"from beneath Python")
    sys.stdout.write("afterwards\n")
    assert capfd.readouterr() == ("afterwards\n", "")


def test_other_threads_are_heard(capfd: pytest.CaptureFixture[str]) -> None:
    inside, printed = threading.Event(), threading.Event()

    def read() -> None:
        with unheard():
            inside.set()
            printed.wait()
            sys.stdout.write("from a library\n")

    thread = threading.Thread(target=read)
    thread.start()
    inside.wait()
    sys.stdout.write("from a script\n")
    sys.stderr.write("of its errors\n")
    os.write(2, b"from beneath Python\n")
    printed.set()
    thread.join()
    assert capfd.readouterr() == ("from a script\n", "of its errors\nfrom beneath Python\n")


def test_a_thread_is_heard_after_its_turn(capfd: pytest.CaptureFixture[str]) -> None:
    inside, printed = threading.Event(), threading.Event()

    def read() -> None:
        with unheard():
            inside.set()
            printed.wait()

    thread = threading.Thread(target=read)
    with unheard():
        thread.start()
        assert not inside.wait(0.1)  # it comes here, and waits for its turn
    inside.wait()
    sys.stdout.write("from a command\n")
    printed.set()
    thread.join()
    assert capfd.readouterr() == ("from a command\n", "")

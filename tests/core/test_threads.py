"""Work on several threads gives what it gives on one, in order and with bounded memory."""

import errno
import os
import threading

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.core.maps.representation import representation
from rsibr.rsibr_addon.core.resample import resample
from rsibr.rsibr_addon.core.threads import VARIABLE, in_order, starting

THREADS = ["1", "2", "5"]


@pytest.mark.parametrize("threads", THREADS)
def test_results_come_in_order(monkeypatch: pytest.MonkeyPatch, threads: str) -> None:
    monkeypatch.setenv(VARIABLE, threads)
    first_may_end = threading.Event()

    def square(number: int) -> int:
        if number == 0 and threads != "1":
            assert first_may_end.wait(60.0), "no other item was begun beside the first"
        first_may_end.set()
        return number * number

    assert list(in_order(square, range(40))) == [number * number for number in range(40)]


@pytest.mark.parametrize("threads", THREADS)
def test_few_results_are_computed_ahead(monkeypatch: pytest.MonkeyPatch, threads: str) -> None:
    monkeypatch.setenv(VARIABLE, threads)
    begun: list[int] = []
    results = in_order(begun.append, range(1000))
    next(results)
    results.close()
    assert len(begun) <= 2 * int(threads) + 1


@pytest.mark.parametrize("threads", THREADS)
def test_an_error_is_the_functions_own(monkeypatch: pytest.MonkeyPatch, threads: str) -> None:
    monkeypatch.setenv(VARIABLE, threads)

    def fails(number: int) -> int:
        raise RuntimeError(f"at {number}")

    with pytest.raises(RuntimeError, match="at 0"):
        list(in_order(fails, range(10)))


def test_threads_that_the_system_does_not_start_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, "64")
    with pytest.raises(RangeError, match="starts no 64 threads"), starting():
        raise RuntimeError(os.strerror(errno.EAGAIN))
    with pytest.raises(RuntimeError, match="of another kind"), starting():
        raise RuntimeError("of another kind")


@pytest.mark.parametrize("target", ["octahedral", "dual_paraboloid", "angular_map"])
@pytest.mark.parametrize("size", [96, 384])
def test_resampled_maps_do_not_depend_on_threads(
    monkeypatch: pytest.MonkeyPatch, target: str, size: int
) -> None:
    image = np.random.default_rng(0).random((1, 256, 512, 3), np.float32)
    made = []
    for threads in THREADS:
        monkeypatch.setenv(VARIABLE, threads)
        made.append(resample(image, representation("equirect"), representation(target), size))
    for other in made[1:]:
        np.testing.assert_array_equal(made[0], other)

"""What is requested is made in a thread, the last request first, and never more than is needed."""

import threading
from collections.abc import Iterator

import pytest
from rsibr.rsibr_addon.tasks.methods.latest_request_worker import LatestRequestWorker

SECONDS = 20.0
"""After these a thread hangs."""


@pytest.fixture
def worker() -> Iterator[LatestRequestWorker]:
    worker = LatestRequestWorker()
    yield worker
    worker.close()
    assert worker._thread is not None
    assert not worker._thread.is_alive()


class Work:
    """Steps that wait to be allowed; an item a step, told where it can be shown."""

    def __init__(self, *shown: bool) -> None:
        self.shown = shown
        self.done: list[int] = []
        self.closed = threading.Event()
        self._allowed = threading.Semaphore(0)
        self._stepped = threading.Semaphore(0)

    def steps(self) -> Iterator[bool]:
        try:
            for number, shown in enumerate(self.shown):
                assert self._allowed.acquire(timeout=SECONDS)
                self.done.append(number)
                self._stepped.release()
                yield shown
        finally:
            self.closed.set()

    def allow(self, count: int = 1) -> None:
        for _ in range(count):
            self._allowed.release()
            assert self._stepped.acquire(timeout=SECONDS)

    def allow_unseen(self) -> None:
        self._allowed.release()


def wait_until_idle(worker: LatestRequestWorker) -> None:
    waiting = threading.Event()
    while worker.is_busy:
        waiting.wait(0.005)


def test_news_come_with_what_can_be_shown(worker: LatestRequestWorker) -> None:
    work = Work(False, True, False)
    worker.request("a", work.steps(), is_urgent=True)
    work.allow()
    assert worker.is_busy
    assert not worker.take_news()
    work.allow(2)
    wait_until_idle(worker)
    assert worker.take_news()
    assert not worker.take_news()
    assert work.done == [0, 1, 2]


def test_an_urgent_request_interrupts_what_can_be_shown_already(worker: LatestRequestWorker) -> None:
    slow, urgent = Work(True, False, False, False), Work(True)
    worker.request("slow", slow.steps(), is_urgent=True)
    slow.allow()
    worker.request("urgent", urgent.steps(), is_urgent=True)
    slow.allow_unseen()  # it may be in its second step already
    urgent.allow()
    assert slow.closed.wait(SECONDS)
    assert len(slow.done) <= 2
    wait_until_idle(worker)
    assert urgent.done == [0]


def test_a_request_that_can_wait_waits(worker: LatestRequestWorker) -> None:
    first, second = Work(True, False), Work(True)
    worker.request("first", first.steps(), is_urgent=True)
    first.allow()
    worker.request("second", second.steps(), is_urgent=False)
    first.allow()
    second.allow()
    wait_until_idle(worker)
    assert (first.done, second.done) == ([0, 1], [0])


def test_of_several_requests_the_last_is_made_and_none_twice(worker: LatestRequestWorker) -> None:
    first, dropped, last, again = Work(False, True), Work(True), Work(True), Work(True)
    worker.request("first", first.steps(), is_urgent=True)
    first.allow()
    worker.request("dropped", dropped.steps(), is_urgent=True)
    worker.request("last", last.steps(), is_urgent=True)
    worker.request("first", again.steps(), is_urgent=True)  # is being made
    first.allow()
    last.allow()
    wait_until_idle(worker)
    assert dropped.done == again.done == []


def test_closing_ends_the_thread_after_a_step() -> None:
    worker, work = LatestRequestWorker(), Work(False, False, False)
    worker.request("a", work.steps(), is_urgent=True)
    work.allow()
    closing = threading.Thread(target=worker.close)
    closing.start()
    work.allow_unseen()
    closing.join(SECONDS)
    assert not closing.is_alive()
    assert work.closed.is_set()
    assert len(work.done) <= 2
    assert not worker.is_busy

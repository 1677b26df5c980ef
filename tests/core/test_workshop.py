"""What is wished for is made in a thread, the last wish first, and never more than is needed."""

import threading
from collections.abc import Iterator

import pytest
from rsibr.rsibr_addon.tasks.methods.latest_request_worker import Workshop

SECONDS = 20.0
"""After these a thread hangs."""


@pytest.fixture
def shop() -> Iterator[Workshop]:
    shop = Workshop()
    shop.open()
    yield shop
    shop.close()
    assert not shop.is_open


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


def wait_until_idle(shop: Workshop) -> None:
    waiting = threading.Event()
    while shop.is_busy:
        waiting.wait(0.005)


def test_news_come_with_what_can_be_shown(shop: Workshop) -> None:
    work = Work(False, True, False)
    shop.wish("a", work.steps(), is_urgent=True)
    work.allow()
    assert shop.is_busy
    assert not shop.take_news()
    work.allow(2)
    wait_until_idle(shop)
    assert shop.take_news()
    assert not shop.take_news()
    assert work.done == [0, 1, 2]


def test_an_urgent_wish_interrupts_what_can_be_shown_already(shop: Workshop) -> None:
    slow, urgent = Work(True, False, False, False), Work(True)
    shop.wish("slow", slow.steps(), is_urgent=True)
    slow.allow()
    shop.wish("urgent", urgent.steps(), is_urgent=True)
    slow.allow_unseen()  # it may be in its second step already
    urgent.allow()
    assert slow.closed.wait(SECONDS)
    assert len(slow.done) <= 2
    wait_until_idle(shop)
    assert urgent.done == [0]


def test_a_wish_that_can_wait_waits(shop: Workshop) -> None:
    first, second = Work(True, False), Work(True)
    shop.wish("first", first.steps(), is_urgent=True)
    first.allow()
    shop.wish("second", second.steps(), is_urgent=False)
    first.allow()
    second.allow()
    wait_until_idle(shop)
    assert (first.done, second.done) == ([0, 1], [0])


def test_of_several_wishes_the_last_is_made_and_none_twice(shop: Workshop) -> None:
    first, dropped, last, again = Work(False, True), Work(True), Work(True), Work(True)
    shop.wish("first", first.steps(), is_urgent=True)
    first.allow()
    shop.wish("dropped", dropped.steps(), is_urgent=True)
    shop.wish("last", last.steps(), is_urgent=True)
    shop.wish("first", again.steps(), is_urgent=True)  # is being made
    first.allow()
    last.allow()
    wait_until_idle(shop)
    assert dropped.done == again.done == []


def test_closing_ends_the_thread_after_a_step() -> None:
    shop, work = Workshop(), Work(False, False, False)
    shop.open()
    shop.wish("a", work.steps(), is_urgent=True)
    work.allow()
    closing = threading.Thread(target=shop.close)
    closing.start()
    work.allow_unseen()
    closing.join(SECONDS)
    assert not closing.is_alive()
    assert work.closed.is_set()
    assert len(work.done) <= 2
    assert not shop.is_busy

"""A thread that makes what viewports request, while they go on showing what they have."""

import threading
from collections.abc import Hashable, Iterator
from dataclasses import dataclass


@dataclass
class _Request:
    """Work to be done, and what for.

    Attributes
    ----------
    key : Hashable
        The same for the same.
    steps : iterator of bool
        Does the work, a step each; True where it has made something that can be shown.
    is_urgent : bool
        Whether there is nothing to be shown yet.
    """

    key: Hashable
    steps: Iterator[bool]
    is_urgent: bool


class LatestRequestWorker:
    """Works on requests in a thread of its own, which starts with the first.

    A view requests anew at every redraw, so only the last request counts: at most one urgent request waits,
    and one other. Work that can be shown already makes room for an urgent request, and is requested again.
    """

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._waiting: dict[bool, _Request] = {}
        self._at_work: _Request | None = None
        self._has_news = False
        self._is_open = True
        self._thread: threading.Thread | None = None

    @property
    def is_busy(self) -> bool:
        """Whether something is being made, or waits."""
        with self._changed:
            return bool(self._at_work or self._waiting)

    def close(self) -> None:
        """Drop all requests and end the thread, which takes as long as a step."""
        with self._changed:
            self._is_open = self._has_news = False
            self._waiting.clear()
            self._changed.notify()
        if self._thread is not None:
            self._thread.join()

    def request(self, key: Hashable, steps: Iterator[bool], is_urgent: bool) -> None:
        """Request something, unless it is being made.

        Parameters
        ----------
        key : Hashable
        steps : iterator of bool
            Runs in the thread, without Blender's data; to its end, or until it is closed.
        is_urgent : bool
            Whether there is nothing to be shown yet.
        """
        with self._changed:
            if self._at_work is None or self._at_work.key != key:
                self._waiting[is_urgent] = _Request(key, steps, is_urgent)
                self._changed.notify()
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="rsibr worker", daemon=True)
                self._thread.start()

    def take_news(self) -> bool:
        """Whether something new can be shown since the last call."""
        with self._changed:
            news, self._has_news = self._has_news, False
        return news

    def _work(self) -> None:
        while (request := self._next()) is not None:
            for can_be_shown in request.steps:
                with self._changed:
                    self._has_news |= can_be_shown
                    request.is_urgent &= not can_be_shown
                    if not self._is_open or (True in self._waiting and not request.is_urgent):
                        break

    def _next(self) -> _Request | None:
        """The next request; None when the worker closes."""
        with self._changed:
            self._at_work = None
            self._changed.wait_for(lambda: self._waiting or not self._is_open)
            if not self._is_open:
                return None
            self._at_work = self._waiting.pop(max(self._waiting))
            return self._at_work

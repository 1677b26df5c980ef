"""Long work as a generator."""

import pytest
from rsibr.rsibr_addon.core.progress import Progress, Steps, drain


def counting(log: list[str], fails_at: int | None = None) -> Steps[str]:
    try:
        for done in range(3):
            if done == fails_at:
                raise OSError("disk full")
            log.append(f"step {done}")
            yield Progress(done, 3, f"step {done + 1}")
        return "result"
    finally:
        log.append("cleaned up")


def test_draining_runs_every_step_and_returns_the_result() -> None:
    log: list[str] = []
    assert drain(counting(log)) == "result"
    assert log == ["step 0", "step 1", "step 2", "cleaned up"]


def test_work_without_steps_still_has_a_result() -> None:
    def nothing_to_do() -> Steps[int]:
        return 7
        yield

    assert drain(nothing_to_do()) == 7


def test_a_failure_comes_through() -> None:
    log: list[str] = []
    with pytest.raises(OSError, match="disk full"):
        drain(counting(log, fails_at=1))
    assert log == ["step 0", "cleaned up"]


def test_abandoned_work_cleans_up() -> None:
    log: list[str] = []
    steps = counting(log)
    assert next(steps) == Progress(done=0, total=3, what="step 1")
    steps.close()
    assert log == ["step 0", "cleaned up"]

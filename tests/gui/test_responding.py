"""Blender goes on drawing while a bake goes on beside it."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.gui.panel import PRELUDE

Told = Callable[[str], dict]

SCENARIO = """
def scenario(told):
    settings()
    hold(1)
    bake()
    running = session().bakes.bakes[0]
    yield from done(lambda: finished_views(running) == 1)
    # It will not go on before this is done, so whatever waited for it here would wait for ever
    before = draws.total()
    for _ in range(10):
        yield from drawn()
    told["while baking"] = [str(running.state), running.progress.done, draws.total() - before >= 20]
    let_go()
    yield from done()
    told["state"] = str(running.state)
"""


@pytest.fixture(autouse=True)
def _nothing_baked(job: Path) -> None:
    for folder in job.glob("user/extensions/.user/*/rsibr/baked"):
        shutil.rmtree(folder)


def test_the_window_is_drawn_while_a_bake_goes_on(told: Told) -> None:
    assert told(PRELUDE + SCENARIO) == {"while baking": ["running", 1, True], "state": "done"}

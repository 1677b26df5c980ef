"""Shadows of floors are made once, however many floors and viewports there are."""

from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.conventions import Array
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.host.world_light import AS_IT_IS
from rsibr.rsibr_addon.tasks.viewport import floors as viewport_floors
from rsibr.rsibr_addon.tasks.viewport.contents import Catcher, Drawable
from rsibr.rsibr_addon.tasks.viewport.floors import Floors

UP = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))
FROM_ABOVE, FROM_BELOW = (np.array([0.0, 0.0, height, 1.0]) for height in (99.0, -99.0))
LIGHT = Environment(np.ones((4, 8, 3), np.float32), "white")


def at(height: float) -> Array:
    place = np.eye(4)
    place[2, 3] = height
    return place


def scene(heights: list[float]) -> Any:
    """A cube of half size 1 about the origin, and floors at some heights."""
    mesh: Any = SimpleNamespace(batch="cube")

    def placed(height: float) -> Drawable:
        surface: Any = SimpleNamespace(matrix=at(height))
        return Drawable(surface, mesh, corners=CORNERS)

    catchers = [Catcher(placed(height), UP) for height in heights]
    return SimpleNamespace(catchers=catchers, light=AS_IT_IS, casters=lambda _: [placed(0.0)])


def viewport(number: int) -> Any:
    return SimpleNamespace(number=number)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """How many shadows, and how many floors' lamps, have been made."""
    counts = {"shadows": 0, "lamps": 0}

    def floor_shadow(*_: Any) -> None:
        counts["shadows"] += 1

    def lamps_above(*given: Any) -> Any:
        counts["lamps"] += 1
        return made_of(*given)

    made_of = viewport_floors.lamps_above
    monkeypatch.setattr(viewport_floors, "floor_shadow", floor_shadow)
    monkeypatch.setattr(viewport_floors, "lamps_above", lamps_above)
    return counts


def test_floors_that_catch_nothing_do_not_push_a_shadow_out(made: dict[str, int]) -> None:
    floors, contents = Floors(), scene([-1.0, *np.linspace(2.0, 3.0, 8)])
    for _ in range(3):
        shadows = [shadow for _, shadow in floors.caught(contents, viewport(1), LIGHT, FROM_ABOVE)]
        assert [shadow is not None for shadow in shadows] == [True] + [False] * 8
    assert made == {"shadows": 1, "lamps": 1}


def test_every_shadow_of_some_viewports_is_made_once(made: dict[str, int]) -> None:
    floors, contents = Floors(), scene(list(np.linspace(-0.9, 0.9, 6)))
    for _ in range(3):
        for number, eye in enumerate([FROM_ABOVE, FROM_BELOW, FROM_ABOVE, FROM_BELOW]):
            floors.caught(contents, viewport(number), LIGHT, eye)
    assert made == {"shadows": 12, "lamps": 2}


def test_what_nobody_shows_any_more_is_let_go(made: dict[str, int]) -> None:
    floors, first = Floors(), scene([-1.0])
    floors.caught(first, viewport(0), LIGHT, FROM_ABOVE)
    floors.caught(scene([-2.0]), viewport(0), LIGHT, FROM_ABOVE)
    floors.caught(first, viewport(0), LIGHT, FROM_ABOVE)
    assert made["shadows"] == 3
    for number in range(1, viewport_floors.KEPT + 1):
        floors.caught(scene([-3.0]), viewport(number), LIGHT, FROM_ABOVE)
    floors.caught(first, viewport(0), LIGHT, FROM_ABOVE)
    assert made["shadows"] == 5

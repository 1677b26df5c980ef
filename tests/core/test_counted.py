"""Numbers of things, and lists of names, in sentences."""

import pytest
from rsibr.rsibr_addon.core.counted import NAMES_SHOWN, counted, in_short


@pytest.mark.parametrize(("number", "told"), [(0, "0 views"), (1, "1 view"), (2, "2 views")])
def test_one_thing_is_no_plural(number: int, told: str) -> None:
    assert counted(number, "view") == told


def test_names_beyond_those_shown_are_counted() -> None:
    names = [f"n{number}" for number in range(NAMES_SHOWN + 2)]
    assert in_short(names[:NAMES_SHOWN]) == ", ".join(names[:NAMES_SHOWN])
    assert in_short(names) == ", ".join(names[:NAMES_SHOWN]) + " and 2 more"
    assert in_short([]) == ""

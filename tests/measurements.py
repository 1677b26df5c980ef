"""Measurements and captures by others, which are no part of the project: beside a checkout, or not there."""

from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "shared" / "data"
DATA = Path(__file__).parent / "data"
"""What is part of the project; its README says whose it is."""


def measurement(name: str) -> Path:
    """A file or folder of others; where there is none, the test is skipped.

    Only tests that ask whether something real is understood need one. What the code does, others show with
    files that they make themselves.
    """
    path = FOLDER / name
    if not path.exists():
        pytest.skip(f"a real measurement, ../shared/data/{name}, is not there")
    return path

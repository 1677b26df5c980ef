"""docs/maths.md names functions that there are, and pages."""

import importlib
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "maths.md").read_text(encoding="utf-8")
FUNCTIONS = sorted(set(re.findall(r"`([a-z_0-9]+(?:\.[a-z_0-9]+)+)`", PAGE)))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_are_there(name: str) -> None:
    module, _, function = name.rpartition(".")
    assert callable(getattr(importlib.import_module(f"rsibr.rsibr_addon.core.{module}"), function))


def test_pages_are_there() -> None:
    pages = re.findall(r"\]\(([\w.-]+)\)", PAGE)
    assert len(pages) > 5
    assert all((DOCS / page).is_file() for page in pages)

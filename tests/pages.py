"""The pages that people read, and the code in them."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
MADE = [DOCS / "references.md", *(DOCS / "api").rglob("*.md")]
"""By `make docs`, from what people write."""

PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    *sorted(str(path.relative_to(ROOT)) for path in DOCS.rglob("*.md") if path not in MADE),
]


def blocks(page: str, language: str) -> Iterator[str]:
    """The code of a language in a page."""
    yield from re.findall(rf"^```{language}\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)


def calls(page: str, program: str) -> list[list[str]]:
    """The arguments in each line of a page's shell blocks that calls a program."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines()]
    words = [shlex.split(line, comments=True) for line in lines]
    return [line[line.index(program) + 1 :] for line in words if program in line]

"""The Python API: a page for each room that imports without Blender, made of its modules' docstrings."""

import ast
import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

ROOT = Path(__file__).parents[2]
ROOMS = ("rsibr_addon/core", "rsibr_addon/files")
"""Folders; those in them are rooms too."""


def setup(app: Sphinx) -> dict[str, Any]:
    """Write the pages before Sphinx looks for pages."""
    app.connect("config-inited", lambda app, _: _write_rooms(Path(app.srcdir) / "api"))
    app.connect("autodoc-process-docstring", lambda *arguments: _escape_bars(arguments[-1]), priority=400)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _escape_bars(lines: list[str]) -> None:
    """The magnitude `|x|` in a docstring, which would be a substitution."""
    lines[:] = [re.sub(r"(?<!`)\|", r"\|", line) for line in lines]


def _write_rooms(out: Path) -> None:
    out.mkdir(exist_ok=True)
    rooms = [
        room for top in ROOMS for room in sorted(path.parent for path in (ROOT / top).rglob("__init__.py"))
    ]
    pages = {_name(room).replace(".", "-") + ".md": _page(room) for room in rooms}
    pages["index.md"] = _index(rooms)
    for stale in {path.name for path in out.iterdir()} - set(pages):
        (out / stale).unlink()
    for name, text in pages.items():
        page = out / name
        if not page.is_file() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


def _name(path: Path) -> str:
    return ".".join(path.relative_to(ROOT / "rsibr_addon").with_suffix("").parts)


def _page(room: Path) -> str:
    modules = [path for path in sorted(room.glob("*.py")) if path.name != "__init__.py"]
    sections = [f"## {module.stem}\n\n{_automodule(_name(module))}" for module in modules]
    return "\n".join([f"# {_name(room)}\n\n{_automodule(_name(room))}", *sections])


def _automodule(name: str) -> str:
    return f"```{{eval-rst}}\n.. automodule:: rsibr.rsibr_addon.{name}\n```\n"


def _index(rooms: list[Path]) -> str:
    """The way to all pages, each room with the first sentence of its docstring."""
    rows = [f"| [{_name(room)}]({_name(room).replace('.', '-')}.md) | {_summary(room)} |" for room in rooms]
    tree = [_name(room).replace(".", "-") for room in rooms]
    return "\n".join(
        [
            "# Python",
            "",
            "What imports without Blender, room by room; each is a part of `rsibr.rsibr_addon`.",
            "[The architecture](../architecture.md) says which room may import which.",
            "",
            "| room | what it holds |",
            "|---|---|",
            *rows,
            "",
            "```{toctree}",
            ":hidden:",
            "",
            *tree,
            "```",
            "",
        ]
    )


def _summary(room: Path) -> str:
    docstring = ast.get_docstring(ast.parse((room / "__init__.py").read_text(encoding="utf-8"))) or ""
    return docstring.split("\n\n")[0].replace("\n", " ")

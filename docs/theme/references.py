"""A page of references, made of references.bib, to which every [Key] in a page links."""

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

ENTRY = re.compile(r"^@\w+\{(\w+),\n(.*?)^\}", re.DOTALL | re.MULTILINE)
FIELD = re.compile(r"^\s*(\w+)\s*=\s*\{(.*)\},?$", re.MULTILINE)
PLACES = ("journal", "booktitle", "publisher", "institution", "school", "note")
"""Fields of which an entry tells those that it has."""


def setup(app: Sphinx) -> dict[str, Any]:
    """Write the page before Sphinx looks for pages, and link to it as each page is read."""
    text = (Path(app.confdir) / "references.bib").read_text(encoding="utf-8")
    entries = {key: dict(FIELD.findall(fields)) for key, fields in ENTRY.findall(text)}
    lines = [f"({key.lower()})=\n**{key}** {_told(entry)}\n" for key, entry in entries.items()]
    (Path(app.srcdir) / "references.md").write_text("\n".join(["# References\n", *lines]), encoding="utf-8")
    links = "".join(f"\n[{key}]: #{key.lower()}" for key in entries)

    def read(app: Sphinx, name: str, source: list[str]) -> None:
        source[0] += f"\n{links}\n"

    app.connect("source-read", read)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _told(entry: dict[str, str]) -> str:
    """An entry in words, with a link to where it is published."""
    authors = [" ".join(reversed(name.split(", "))) for name in entry["author"].split(" and ")]
    places = [entry[place] for place in PLACES if place in entry]
    numbers = (
        [entry["volume"] + (f" ({entry['number']})" if "number" in entry else "")]
        if "volume" in entry
        else []
    )
    pages = [f"pages {entry['pages']}"] if "pages" in entry else []
    told = (
        f"{', '.join(authors)}: *{entry['title']}*. {', '.join([*places, *numbers, *pages, entry['year']])}."
    )
    for written, meant in (("{", ""), ("}", ""), ("``", "“"), ("''", "”"), ("--", "–"), ("\\&", "&")):
        told = told.replace(written, meant)
    address = f"https://doi.org/{entry['doi']}" if "doi" in entry else entry.get("url")
    return f"{told} <{address}>" if address else told

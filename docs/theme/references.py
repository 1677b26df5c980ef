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
    citation = re.compile(rf"\[({'|'.join(entries)})\]")

    def link(app: Sphinx, name: str, source: list[str]) -> None:
        source[0] = citation.sub(lambda found: rf"[\[{found[1]}\]](#{found[1].lower()})", source[0])

    app.connect("source-read", link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _told(entry: dict[str, str]) -> str:
    """An entry in words, with a link to where it is published."""
    authors = ", ".join(" ".join(reversed(name.split(", "))) for name in entry["author"].split(" and "))
    volume = entry.get("volume", "") + (f" ({entry['number']})" if "number" in entry else "")
    pages = f"pages {entry['pages']}" if "pages" in entry else ""
    places = (*(entry.get(place, "") for place in PLACES), volume.strip(), pages, entry["year"])
    told = f"{authors}: *{entry['title']}*. {', '.join(filter(None, places))}."
    for written, meant in (("{", ""), ("}", ""), ("``", "“"), ("''", "”"), ("--", "–"), ("\\&", "&")):
        told = told.replace(written, meant)
    address = f"https://doi.org/{entry['doi']}" if "doi" in entry else entry.get("url")
    return f"{told} <{address}>" if address else told

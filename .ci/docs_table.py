"""Write what a benchmark measured into the docs, between the two comments that say so."""

from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"


def write_table(page: str, name: str, table: str) -> None:
    """Replace a measured table.

    Parameters
    ----------
    page : str
        File in docs.
    name : str
        As in the page's comment `<!-- measured: NAME -->`.
    table : str
        Markdown.
    """
    path = DOCS / page
    before, start, rest = path.read_text(encoding="utf-8").partition(f"<!-- measured: {name} -->\n")
    _, end, after = rest.partition("<!-- end -->\n")
    if not (start and end):
        raise SystemExit(f"docs/{page} has no place for the table {name}.")
    path.write_text(f"{before}{start}{table.rstrip()}\n{end}{after}", encoding="utf-8")

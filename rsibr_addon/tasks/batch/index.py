"""The page of a batch: all its bakes, with pictures, times and errors, in one file without scripts."""

from collections.abc import Mapping, Sequence
from html import escape
from itertools import groupby
from os.path import relpath
from pathlib import Path
from string import Template
from urllib.parse import quote

from ...core.counted import counted
from ...files.atomic import write_changed
from ...files.map_set_facts import in_words
from .bakes import BatchBake
from .notes import Failure, Note

TEMPLATE = Path(__file__).with_suffix(".html")


def write_index(
    page: Path,
    title: str,
    bakes: Sequence[BatchBake],
    notes: Sequence[Note | None],
    failures: Mapping[str, Failure],
) -> None:
    """Write the page.

    Parameters
    ----------
    page : Path
        Replaced if it exists.
    title : str
    bakes : sequence of BatchBake
        Those in the same environment behind each other.
    notes : sequence of Note or None
        Of each bake.
    failures : mapping of str to Failure
        By output.

    Raises
    ------
    OutputFileError
    """
    known = [note for note in notes if note]
    seconds, processor = (sum(note[name] for note in known) for name in ("seconds", "processor"))
    failed = [bake for bake in bakes if bake.job.output in failures]
    shown = zip(bakes, notes, strict=True)
    text = Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        title=escape(in_words(title)),
        summary=f"{counted(len(bakes), 'bake')}, {len(failed)} failed; {seconds:.1f} s of work, "
        f"{processor:.1f} s of processors",
        failures="\n".join(
            f"<li><b>{escape(bake.title)}</b>: {escape(failures[bake.job.output]['error'])}</li>"
            for bake in failed
        ),
        environments="\n".join(
            f'<h2>{escape(environment)}</h2><div class="bakes">'
            + "\n".join(_figure(page, bake, note, failures) for bake, note in group)
            + "</div>"
            for environment, group in groupby(shown, key=lambda each: each[0].environment)
        ),
    )
    write_changed(page, text)


def _figure(page: Path, bake: BatchBake, note: Note | None, failures: Mapping[str, Failure]) -> str:
    name, method = bake.material or bake.job.settings.LABEL, bake.job.settings.LABEL
    link = quote(relpath(bake.job.output, page.parent))
    told, picture, warnings = ["failed" if bake.job.output in failures else "not known"], "", ""
    if note:
        told = [note["told"], f"{note['seconds']:.2f} s"] if note["seconds"] else ["there before this batch"]
        picture = f'<img alt="" src="data:image/png;base64,{note["picture"]}">'
        told += [f"{what.replace('_', ' ')} {error:.2g}" for what, error in note["errors"].items()]
        warnings = "".join(
            f"<details><summary>{escape(warning)}</summary></details>" for warning in note["warnings"]
        )
    lines = "<br>".join([f'<a href="{link}">{escape(name)}</a>', escape(method), *map(escape, told)])
    return f"<figure>{picture or '<div></div>'}<figcaption>{lines}{warnings}</figcaption></figure>"

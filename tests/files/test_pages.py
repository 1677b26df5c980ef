"""Code in pages is understood: commands, targets, scripts; and what pages name is there."""

import ast
import json
import re
import runpy
import sys
from itertools import pairwise

import pytest
from rsibr.rsibr_addon.command_line.commands import parsed
from rsibr.tests.pages import PAGES, ROOT, blocks, calls

every_page = pytest.mark.parametrize("page", PAGES)


@every_page
def test_commands_are_understood(page: str) -> None:
    for words in calls(page, "rsibr"):
        if words != ["--help"]:
            assert callable(parsed(words).run), words


@every_page
def test_targets_of_make_are_there(page: str) -> None:
    targets = re.findall(r"^([\w-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE)
    for (target,) in calls(page, "make"):
        assert target in targets


@every_page
def test_scripts_and_data_are_well_formed(page: str) -> None:
    for script in blocks(page, "python"):
        ast.parse(script)
    for text in blocks(page, "json"):
        json.loads(text)


@every_page
def test_keys_are_in_the_bibliography(page: str) -> None:
    known = re.findall(r"^@\w+\{(\w+),", (ROOT / "docs/references.bib").read_text(), re.MULTILINE)
    assert set(re.findall(r"\[([A-Z]\w+\d{4})\]", (ROOT / page).read_text())) <= set(known)


@every_page
def test_links_lead_to_files(page: str) -> None:
    links = re.findall(r"\]\(([\w./-]+)(?:#[\w-]+)?\)", (ROOT / page).read_text())
    made = "api/index.md"  # with the site
    assert all(link == made or ((ROOT / page).parent / link).is_file() for link in links), links


@pytest.mark.parametrize("page", [*PAGES, "CHANGELOG.md"])
def test_lines_are_short_and_headings_stand_alone(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8").partition("<!-- made from")[0]
    prose = re.sub(r"^ *```.*?^ *```$", "```", text, flags=re.DOTALL | re.MULTILINE)
    lines = prose.splitlines()
    whole = re.compile(r"\||#| *!\[")  # rows, headings and pictures are one line each
    assert not [line for line in lines if len(line) > 120 and not whole.match(line)]
    assert not [line for line, below in pairwise(lines) if re.match("#+ ", line) and below]


def test_commands_are_found() -> None:
    assert sum(len(calls(page, "rsibr")) for page in PAGES) > 40


@pytest.mark.skipif(sys.version_info < (3, 13), reason="argparse of older Pythons lays usage out otherwise")
def test_the_reference_is_that_of_the_options_help() -> None:
    make = runpy.run_path(str(ROOT / ".ci" / "docs_commands.py"))["written_anew"]
    page = (ROOT / "docs/commands.md").read_text(encoding="utf-8")
    assert page == make(page), "`.venv/bin/python .ci/docs_commands.py` writes it anew"

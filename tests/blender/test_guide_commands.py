"""What the guide and the README tell people to type is understood."""

import json
import re
import shlex
from collections.abc import Iterator
from pathlib import Path

import bpy
import pytest
import rsibr
from rsibr.rsibr_addon.command_line.main import parsed
from rsibr.rsibr_addon.job import BakeJob

ROOT = Path(__file__).parents[2]
PAGES = ["docs/guide.md", "README.md"]


def blocks(page: str, language: str) -> Iterator[str]:
    yield from re.findall(rf"^```{language}\n(.*?)^```", (ROOT / page).read_text(), re.DOTALL | re.MULTILINE)


@pytest.mark.parametrize("page", PAGES)
def test_commands_are_understood(page: str) -> None:
    lines = [line for block in blocks(page, "sh") for line in block.splitlines()]
    commands = [shlex.split(line, comments=True) for line in lines if re.search(r"(^| )rsibr ", line)]
    assert len(commands) > 5
    for words in commands:
        assert callable(parsed(words[words.index("rsibr") + 1 :]).run)


def test_jobs_are_understood() -> None:
    (text,) = blocks("docs/guide.md", "json")
    assert callable(parsed(BakeJob.from_json(text, "guide").arguments).run)
    assert json.loads(text)["arguments"][0] == "capture"


def test_operators_are_there_with_their_properties() -> None:
    (script,) = blocks("docs/guide.md", "python")
    calls = re.findall(r"bpy\.ops\.rsibr\.(\w+)\((.*)\)", script)
    assert len(calls) == len(script.splitlines())
    rsibr.register()
    try:
        for name, arguments in calls:
            known = getattr(bpy.ops.rsibr, name).get_rna_type().properties.keys()
            assert set(re.findall(r"(\w+)=", arguments)) <= set(known)
    finally:
        rsibr.unregister()

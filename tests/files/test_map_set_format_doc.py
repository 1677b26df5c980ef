"""docs/map-set-format.md tells the truth: its program runs, and its example is a good description."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set import read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_check import check_header
from rsibr.rsibr_addon.files.map_set_data import MapSet

DOC = (Path(__file__).parents[2] / "docs" / "map-set-format.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    (code,) = re.findall(rf"```{language}\n(.*?)```", DOC, re.DOTALL)
    return code


def run_example(tmp_path: Path, map_set: Path) -> subprocess.CompletedProcess[str]:
    program = tmp_path / "example.py"
    program.write_text(block("python"))
    # Isolated, and from elsewhere: nothing of ours is in reach by accident
    command = [sys.executable, "-I", program, map_set]
    return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)


@pytest.mark.parametrize("half", [False, True])
def test_the_program_reads_a_map_set(tmp_path: Path, make_views: Callable[..., MapSet], half: bool) -> None:
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_views(), half=half)
    run = run_example(tmp_path, path)
    assert run.returncode == 0, run.stderr
    lines = [line.split() for line in run.stdout.splitlines()]
    parts = read_map_set_header(path)["parts"]
    assert [line[:4] for line in lines] == [[p["name"], p["role"], *map(str, p["size"])] for p in parts]
    np.testing.assert_array_equal(np.float64(lines[1][4:]), parts[1]["view_dir"])
    assert "rsibr_addon" not in block("python")


def test_the_program_refuses_a_damaged_one(tmp_path: Path, make_views: Callable[..., MapSet]) -> None:
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, make_views())
    whole = path.read_bytes()
    path.write_bytes(whole[:-100])
    assert run_example(tmp_path, path).returncode != 0


def test_the_example_is_a_good_description() -> None:
    example = block("json")
    for shortened in set(re.findall(r'"([0-9a-f]{4})\.\.\."', example)):
        example = example.replace(f"{shortened}...", shortened * 16)
    header = json.loads(example)
    check_header(header, "the example")
    del header["parts"][2]  # of a view, which then lacks it
    with pytest.raises(MapSetError):
        check_header(header, "the example")


def test_every_field_of_every_role_is_told() -> None:
    table = [line for line in DOC.splitlines() if line.startswith("| `")]
    roles = [(kind, *each) for kind, stored in STORED.items() for each in stored.roles.items()]
    for kind, role, schema in roles:
        (row,) = [line for line in table if line.startswith(f"| `{kind}` |") and f"`{role}`" in line]
        assert all(f"`{field}`" in row for field in schema.__annotations__)

"""What has not the memory that it needs is refused before it starts; a bake never holds all its maps."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.filtering import prefilter
from rsibr.rsibr_addon.files import memory
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance

LOBES = ("bake", "--brdf", "ggx:alpha=0.5,metal=copper", "--lobes", "1", "--slices", "2")

COMMANDS = {
    "bake": ((*LOBES, "--size"), 512),
    "bank": (("bank", "--size"), 512),
    "mips": (("mips", "--size"), 512),
    "tables": (("tables", "--material", "plastic", "--rows"), 512),
}
"""A command but for the size, which comes last; and a size."""

PEAK = """
import resource, sys
from rsibr.rsibr_addon.command_line.main import run
sys.exit(run(sys.argv[1:]) or print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss))
"""


@pytest.fixture(autouse=True)
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An environment, light.exr, in the folder to work in."""
    monkeypatch.chdir(tmp_path)
    write_radiance(tmp_path / "light.exr", np.ones((64, 128, 3), np.float32))


def told(*command: str, capfd: pytest.CaptureFixture[str]) -> dict:
    run([*command, "--environment", "light.exr", "-o", "a.rsibr.exr", "--json", "--progress", "none"])
    return json.loads(capfd.readouterr().out.splitlines()[-1])


@pytest.mark.parametrize("name", COMMANDS)
def test_the_size_that_would_do_is_said_before_any_map_is_made(
    name: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    command, size = COMMANDS[name]
    # Enough for about a 16th of it
    left = prefilter.BYTES_BESIDES + 10e6
    monkeypatch.setattr(memory, "memory_left", lambda: left)
    answer = told(*command, str(size), capfd=capfd)
    assert not answer["ok"]
    found = re.fullmatch(
        r"a\.rsibr\.exr takes .* GB of memory at \d+x(\d+), .*: shrink it to \d+x(\d+) at most\.",
        answer["error"],
    )
    assert found is not None, answer["error"]
    assert int(found[1]) == size
    assert 16 <= int(found[2]) < size
    assert [path.name for path in Path().iterdir()] == ["light.exr"]
    fitting = 2 ** (int(found[2]).bit_length() - 1)
    assert told(*command, str(fitting), capfd=capfd)["ok"]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no getrusage")
@pytest.mark.slow
def test_all_maps_of_a_stack_are_never_in_memory() -> None:
    def peak(slices: int) -> int:
        command = (*LOBES[:-1], str(slices), "--size", "256", "--environment", "light.exr")
        output = subprocess.run(
            [sys.executable, "-c", PEAK, *command, "-o", f"{slices}.rsibr.exr", "--progress", "none"],
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        return int(output.splitlines()[-1]) * (1 if sys.platform == "darwin" else 1024)

    # 120 maps more, of 1.6 MB each, are not even half of that more
    assert peak(128) - peak(8) < 120 * 2 * 256**2 * 12 / 2

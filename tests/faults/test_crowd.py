"""Two Blenders that bake for a panel and three commands in one folder at once: all is right."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.map_set import read_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.job import CommandJob
from rsibr.tests.faults.processes import Running

pytestmark = [pytest.mark.needs("bpy"), pytest.mark.slow]

BAKE = "bake --environment light.exr --brdf phong:ks=0.5,n=8 --lobes 1 --slices 6 -o baked.rsibr.exr"
MIPS = "mips --environment light.exr --filter box --size 32 -o"
COMMANDS = {
    "faces": "convert light.exr faces.exr --from equirect --to cube_faces --size 32",
    "mips": f"{MIPS} mips.rsibr.exr",
    # Of two that write the same file, the last one waits and finds it, or is late and says that it is there
    "same": f"{MIPS} same.rsibr.exr",
    "same too": f"{MIPS} same.rsibr.exr",
}


@pytest.mark.parametrize("time", range(3))
def test_all_is_right_and_nothing_is_left(time: int, tmp_path: Path) -> None:
    work = tmp_path / "work"
    work.mkdir()
    write_radiance(work / "light.exr", np.random.default_rng(1).random((64, 128, 3)))
    (work / "job.json").write_text(CommandJob(tuple(BAKE.split())).to_json())
    started = {
        name: Running(tmp_path, *command.split())
        for name, command in (COMMANDS | dict.fromkeys(("one", "other"), "bake job.json")).items()
    }
    ended = {name: running.end() for name, running in started.items()}
    refused = {name: end.err for name, end in ended.items() if end.code}
    assert refused.keys() <= {"same"} or refused.keys() <= {"same too"}, refused
    for sentence in refused.values():
        assert sentence.startswith("rsibr: error: same.rsibr.exr exists: ")
        assert len(sentence.splitlines()) == 1
    faces = {f"faces-{name}.exr" for name in ("px", "nx", "py", "ny", "pz", "nz")}
    maps = {f"{name}.rsibr.exr" for name in ("baked", "mips", "same")}
    assert {path.name for path in work.iterdir()} == faces | maps | {"light.exr", "job.json"}
    for name in maps:
        read_map_set(work / name)
    assert list((tmp_path / "temporary").iterdir()) == []

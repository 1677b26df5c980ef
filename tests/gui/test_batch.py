"""Within Blender, the processes of a batch are Blenders."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance


def test_a_batch_bakes_in_blenders(
    blender: Callable[..., subprocess.CompletedProcess[str]], job: Path
) -> None:
    write_radiance(job / "even.exr", np.ones((16, 32, 3)))
    views = {"kind": "radiance_views", "size": 8, "samples": 2}
    batch = {"environments": ["even.exr"], "materials": ["copper", "clay"], "methods": [views]}
    (job / "metals.json").write_text(json.dumps(batch))
    done = blender("--background", "--command", "rsibr", "batch", "/job/metals.json", "--json")
    result = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
    assert result["ok"], result
    assert result["made"] == 2
    for name in ("copper", "clay"):
        assert "Blender" in read_map_set_header(job / f"even-{name}.rsibr.exr")["software"]
    assert (job / "metals-batch" / "index.html").is_file()

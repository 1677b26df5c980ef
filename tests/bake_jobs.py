"""Jobs as the panel has them done."""

from pathlib import Path
from typing import Any

from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.job import BakeJob


def run_job(job: BakeJob[Any], folder: Path) -> int:
    """Write a job into a folder and run `rsibr bake` with it; its exit code."""
    path = folder / "job.json"
    path.write_text(job.to_json(), encoding="utf-8")
    code = run(["bake", str(path), "--progress", "none"])
    path.unlink()
    return code

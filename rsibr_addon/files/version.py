"""Our name and version, for the files that we write."""

import tomllib
from functools import cache
from pathlib import Path

MANIFEST = Path(__file__).parents[2] / "blender_manifest.toml"


@cache
def rsibr() -> str:
    """Name and version of RSIBR, as "rsibr 0.2.0"."""
    manifest = tomllib.loads(MANIFEST.read_text(encoding="utf-8"))
    return f"{manifest['id']} {manifest['version']}"

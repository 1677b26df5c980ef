"""Our name and version, for the files that we write."""

import re
from functools import cache
from pathlib import Path

MANIFEST = Path(__file__).parents[2] / "blender_manifest.toml"


@cache
def rsibr() -> str:
    """Name and version of RSIBR, as "rsibr 0.2.0"."""
    # Of these lines a pattern tells as much as tomllib, whose import takes 0.01 s
    manifest = dict(re.findall(r'^(\w+) = "(.*)"$', MANIFEST.read_text(encoding="utf-8"), re.MULTILINE))
    return f"{manifest['id']} {manifest['version']}"

"""Our name and version, for the files that we write."""

import tomllib
from pathlib import Path

import bpy

MANIFEST = Path(__file__).parents[2] / "blender_manifest.toml"


def software() -> str:
    """Names and versions of RSIBR and Blender, as "rsibr 0.1.0, Blender 5.2.0"."""
    manifest = tomllib.loads(MANIFEST.read_text())
    return f"{manifest['id']} {manifest['version']}, Blender {bpy.app.version_string}"

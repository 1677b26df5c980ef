"""The Blender that is there, if any: its program, and the environments that come with it."""

import sys
from importlib.util import find_spec
from pathlib import Path


def has_blender() -> bool:
    """Whether Blender runs here or can be imported."""
    return "bpy" in sys.modules or find_spec("bpy") is not None


def blender_program() -> str:
    """The program of this Blender; empty where Blender is a module of Python."""
    import bpy

    return bpy.app.binary_path


def studio_environments() -> dict[str, Path]:
    """The environments that come with Blender, by bare name, as "forest"; none where there is no Blender."""
    return {path.stem: path for folder in _folders() for path in sorted(folder.glob("*.exr"))}


def _folders() -> list[Path]:
    if "bpy" in sys.modules:
        import bpy

        return [Path(bpy.utils.system_resource("DATAFILES", path="studiolights/world"))]
    spec = find_spec("bpy")
    # The package of bpy has Blender's files in a folder of its version
    within = spec.submodule_search_locations or [] if spec else []
    return [folder for each in within for folder in Path(each).glob("*/datafiles/studiolights/world")]

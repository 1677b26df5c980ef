"""Every function of gpu_shaders/lib has a test against its numpy twin in a module test_library*.py."""

import importlib
import re
from pathlib import Path

from rsibr.rsibr_addon.device.shader_source import SHADER_FOLDER


def test_no_function_of_the_library_goes_untested() -> None:
    defined = set()
    for path in sorted((SHADER_FOLDER / "lib").glob("*.glsl")):
        # Definitions start a line; what functions hold is indented.
        functions = re.findall(r"^\w+ (\w+)\(", path.read_text(), flags=re.MULTILINE)
        assert functions, path
        defined.update(functions)
    tested = set()
    for path in Path(__file__).parent.glob("test_library*.py"):
        module = importlib.import_module(f"rsibr.tests.glsl.{path.stem}")
        # A twin's name may go on after the function's: "albedo_at single normal".
        tested |= {name.partition(" ")[0] for name in getattr(module, "TWINS", ())}
        tested |= {name.removeprefix("test_") for name in vars(module) if name.startswith("test_")} & defined
    assert tested == defined

"""GLSL files with their includes resolved; Blender's `gpu` module has no include of its own."""

import re
from functools import cache
from pathlib import Path

from ..core.errors import DeviceError

SHADER_FOLDER = Path(__file__).resolve().parents[2] / "gpu_shaders"

_INCLUDE = re.compile(r'^#include "([^"]+)"$')


@cache
def shader_source(name: str) -> str:
    """A shader file of `gpu_shaders` with every `#include "lib/..."` replaced by its text, once.

    Parameters
    ----------
    name : str
        Path below `gpu_shaders`.

    Returns
    -------
    str
        GLSL; `#line` directives keep the line numbers of error messages those of the files.

    Raises
    ------
    DeviceError
        The file, or one that it includes, does not exist: the installation is damaged.
    """
    return "\n".join(_lines(name, set()))


def _lines(name: str, included: set[str]) -> list[str]:
    included.add(name)
    try:
        text = (SHADER_FOLDER / name).read_text(encoding="utf-8")
    except OSError as error:
        raise DeviceError(f"The shader {name} is missing: install the extension again.") from error
    lines = ["#line 1"]
    for number, line in enumerate(text.splitlines(), start=1):
        match = _INCLUDE.match(line)
        if match is None:
            lines.append(line)
        elif match[1] not in included:
            lines += [*_lines(match[1], included), f"#line {number + 1}"]
    return lines

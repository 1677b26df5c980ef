"""A look that starts from an object's own material."""

from dataclasses import replace
from typing import Any

from ....core.materials.principled import Input, PrincipledInputs
from ....core.options import declared_options
from ....core.warned import warn


def with_constants(look: Any, inputs: PrincipledInputs) -> Any:
    """A look with the constants of a Principled material.

    Parameters
    ----------
    look : Options
        Of a kind that shades Principled materials.
    inputs : PrincipledInputs

    Warns
    -----
    RsibrWarning
        Something of the material is no constant, and so keeps the look's own value.
    """
    constants: dict[str, Any] = {}
    others = []
    for declared in declared_options(type(look)):
        read = getattr(inputs, declared.name, None)
        if isinstance(read, Input) and read.texture is None:
            least, most = declared.option.least, declared.option.most
            numbers = tuple(min(max(number, least), most) for number in read.constant)
            constants[declared.name] = numbers if declared.wanted is tuple else numbers[0]
        elif read is not None:
            others.append(declared.option.label)
    if others:
        warn(f"The page has no textures, and a slider each instead: {', '.join(others)}.")
    return replace(look, **constants)

"""An environment to a bank of kernels, in a map set: materials are chosen while one looks."""

from dataclasses import dataclass
from pathlib import Path

from ...core.filtering.prefilter import BYTES_BESIDES
from ...core.kinds.lobe_stack.stack import LAYOUTS, stack_representation
from ...core.lobes.bake import BakedBank, bake_bank
from ...core.progress import Progress, Steps
from ...files.atomic import check_target
from ...files.kinds.kernel_bank import to_map_set
from ...files.map_set import write_map_set
from ...files.memory import check_memory
from ...host.version import software
from ..light.environments import load_environment


@dataclass(frozen=True)
class BankSettings:
    """How maps are laid out.

    Attributes
    ----------
    layout : str
        One of `core.kinds.lobe_stack.stack.LAYOUTS`.
    size : int
        Width of the maps in texels.

    Raises
    ------
    RangeError
        There is no such layout, or the size is out of range.
    """

    layout: str = LAYOUTS[0]
    size: int = 128

    def __post_init__(self) -> None:
        stack_representation(self.layout, self.size)


def bake_environment(
    environment: str | None,
    settings: BankSettings,
    output: Path,
    force: bool = False,
    clamp: float | None = None,
) -> Steps[BakedBank]:
    """Filter an environment with every kernel that the maps resolve.

    Parameters
    ----------
    environment : str or None
        A latitude-longitude file, a name of one of Blender's own, or None for the open file's world:
        see `load_environment`.
    settings : BankSettings
    output : Path
        By custom NAME.rsibr.exr.
    force : bool
        Whether an existing file is replaced.
    clamp : float, optional
        See `core.environment.usable_radiance`.

    Yields
    ------
    Progress

    Returns
    -------
    BakedBank
        What was written.

    Raises
    ------
    InputFileError, OutputFileError, SceneError, RenderError
    RangeError
        The environment resolves no kernel, or the maps are too large for this machine's memory.

    Warns
    -----
    RsibrWarning
        See `load_environment`.
    """
    check_target(output, force)
    yield Progress(0, 1, "reading the environment")
    light = load_environment(environment, clamp)

    def afford(needed: float, size: int) -> None:
        check_memory(needed, str(output), (size, size), BYTES_BESIDES)

    baked = yield from bake_bank(light.radiance, settings.layout, settings.size, afford)
    stated = {"layout": settings.layout, "size": settings.size}
    yield Progress(0, 1, f"writing {output.name}")
    write_map_set(output, to_map_set(baked, light, stated, software()), force)
    return baked

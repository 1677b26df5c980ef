"""One bake of a batch, and the parts that a batch falls into."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ...files.output_paths import portable_name
from ...job import BakeJob


@dataclass(frozen=True)
class Opened:
    """A file of Blender that is open while a bake is done.

    Attributes
    ----------
    file : str
    original : str
        The file of which it is a copy, for what the map set says of its material; empty if that has no name.
    """

    file: str
    original: str


@dataclass(frozen=True)
class BatchBake:
    """One bake of a batch.

    Attributes
    ----------
    environment, material : str
        Names for people; the material's is empty where light alone is baked.
    job : BakeJob
    opened : Opened or None
        What is opened before, whose world or material the job means.
    """

    environment: str
    material: str
    job: BakeJob[Any]
    opened: Opened | None = None

    @property
    def title(self) -> str:
        """What is baked, in words."""
        return f"{self.material or self.job.settings.LABEL} in {self.environment}"


def parts_of(bakes: Sequence[BatchBake]) -> dict[str, list[BatchBake]]:
    """The bakes of each environment and method, by a name of the two, in the order of `bakes`."""
    parts: dict[tuple[str | None, Opened | None, str], list[BatchBake]] = {}
    for bake in bakes:
        parts.setdefault((bake.job.light.environment, bake.opened, bake.job.settings.KIND), []).append(bake)
    named: dict[str, list[BatchBake]] = {}
    for (_, _, kind), part in parts.items():
        name = plain = portable_name(f"{part[0].environment}-{kind}".replace("_", "-"))
        number = 1
        while name in named:
            name = f"{plain}-{(number := number + 1)}"
        named[name] = part
    return named

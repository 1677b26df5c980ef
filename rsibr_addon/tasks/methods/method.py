"""What a method of making map sets is, and what all of them share."""

import os
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...core.brdf.lambert import Lambert
from ...core.brdf.model import Brdf
from ...core.brdf.spec import ReadMeasured
from ...core.environment import Environment
from ...core.progress import Progress, Steps
from ...files.map_set import check_map_set_target, write_map_set
from ...files.map_set_header import Recipe
from ...files.memory import check_memory
from ...files.version import rsibr
from ...job import BakeJob
from ..light.environments import environment_file, load_environment

BLENDER_MEMORY = 350e6
"""Bytes that a background Blender takes with a small file, before any work."""

BLENDER_SECONDS = 3.0
"""Processor time that it takes to start."""

ENVIRONMENT_ROWS = 512
"""Rows of an environment that comes with Blender, and of a world."""

ENVIRONMENT_TEXELS = 2 * ENVIRONMENT_ROWS**2
"""Texels of such an environment."""

STORED = 0.7
"""Share of a float of radiance that remains when it is compressed, measured on captures of ours."""

RGB = 3 * 4
"""Bytes of a texel."""


@dataclass(frozen=True)
class Cost:
    """Estimated cost of making a map set.

    Attributes
    ----------
    processor_seconds : float
        Seconds of all cores together, without the start of Blender, which batches share.
    memory : float
        Bytes.
    disk : float
        Bytes, of the finished file.
    """

    processor_seconds: float
    memory: float
    disk: float

    @property
    def seconds(self) -> float:
        """Estimated duration [s] with the start of Blender, if all cores share the work alone."""
        return (BLENDER_SECONDS + self.processor_seconds) / (os.cpu_count() or 1)


def measured_files(describe: Callable[[ReadMeasured], object]) -> tuple[str, ...]:
    """The files that a material's text names, none of which is opened.

    Parameters
    ----------
    describe : callable
        Makes the material, with a function that reads its measured models.
    """
    paths = []

    def read(format: str, path: str) -> Brdf:
        paths.append(path)
        return Lambert(kd=0.5)

    describe(read)
    return tuple(paths)


ENVIRONMENT_MEMORY = ENVIRONMENT_TEXELS * RGB
"""Bytes of such an environment."""


def cost_in_blender(seconds: float, memory: float, disk: float) -> Cost:
    """What a method costs, in units of `Cost`, with Blender and the environment that its file holds."""
    return Cost(seconds, BLENDER_MEMORY + memory, disk + STORED * ENVIRONMENT_MEMORY)


@dataclass(frozen=True)
class Baked:
    """What a method has made.

    Attributes
    ----------
    path : Path
        The map set.
    told : str
        What it is, in a few words for people.
    figures : dict
        The same and more for programs, as JSON values.
    """

    path: Path
    told: str
    figures: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Sources:
    """What settings take from elsewhere.

    Attributes
    ----------
    files : tuple of str
        Files that they name, but for files of Blender.
    material : str or None
        The material that Blender makes or holds, as `host.materials.load_material` names it.
    listed : tuple of str
        Where the first of `files` lists the others: their names in it, relative to its folder.
    lights : tuple of str
        Environments that they name, as `light.environments.environment_file` takes them.
    """

    files: tuple[str, ...] = ()
    material: str | None = None
    listed: tuple[str, ...] = ()
    lights: tuple[str, ...] = ()

    @property
    def named(self) -> dict[str, Path]:
        """Each of `files` and `lights` as the settings name it -> its file.

        Raises
        ------
        InputFileError
            There is no environment of this name.
        """
        lights = {light: Path(environment_file(light)) for light in self.lights}
        return {file: Path(file) for file in self.files if file} | lights


@dataclass(frozen=True)
class Method:
    """A way to make map sets.

    Attributes
    ----------
    bake : callable
        A `BakeJob`, whose output can be written, and its `Recipe`, to `Steps` that end with a `Baked`. Raises
        what `read_light` does, and warns of what `core.environment.usable_radiance` does.
    cost : callable
        Settings to what they cost in an environment as large as those of Blender.
    material : callable
        Settings to the material's name in words; empty where a map set holds light alone.
    sources : callable
        Settings to their `Sources`. Raises RangeError where the settings describe no material.
    recipe : callable or None
        A `BakeJob` to its `Recipe`; None for what follows from its light and its `Sources`.
    """

    bake: Callable[[BakeJob[Any], Recipe], Steps[Baked]]
    cost: Callable[[Any], Cost]
    material: Callable[[Any], str] = lambda settings: ""
    sources: Callable[[Any], Sources] = lambda settings: Sources()
    recipe: Callable[[BakeJob[Any]], Recipe] | None = None


def read_light(job: BakeJob[Any]) -> Steps[Environment]:
    """Read the environment of a job, if its output can be written.

    Raises
    ------
    OutputFileError
        The output exists, or cannot be written.
    InputFileError, SceneError, RenderError
        See `load_environment`.
    """
    check_map_set_target(job.output, job.force)
    yield Progress(0, 1, "reading the environment")
    return load_environment(job.light.environment, job.light.clamp, job.light.bare_world)


def software_of(job: BakeJob[Any], measured: bool = False) -> str:
    """What makes a job's maps, in words: RSIBR, and Blender if it gives the light or what is `measured`."""
    if job.light.environment is not None and not measured:
        return rsibr()
    from ...host.version import software

    return software()


def afforded_by(job: BakeJob[Any], besides: float) -> Callable[[float, int], None]:
    """A function of bytes needed and width that refuses maps too large for this machine's memory.

    Parameters
    ----------
    job : BakeJob
    besides : float
        See `files.memory.check_memory`.
    """

    def afford(needed: float, size: int) -> None:
        check_memory(needed, job.output, (size, size), besides)

    return afford


def written(job: BakeJob[Any], recipe: Recipe, map_set: Any, half: bool = False) -> Steps[Path]:
    """Write a job's map set.

    Parameters
    ----------
    job : BakeJob
    recipe : Recipe
        Of the job; the description states it.
    map_set : MapSet or MapsInTurn
    half : bool
        Store 16-bit floats.
    """
    output = Path(job.output)
    yield Progress(0, 1, f"writing {output.name}")
    stated = replace(map_set, header={**map_set.header, "recipe": recipe})
    write_map_set(output, stated, job.force, half)
    return output

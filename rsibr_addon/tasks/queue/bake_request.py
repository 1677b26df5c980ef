"""From what an artist has chosen to a bake in the background, and the file that it makes."""

import hashlib
import json
import re
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...core.errors import MapSetError, SceneError
from ...files.map_set import read_map_set
from ...files.output_paths import comparison_beside
from ...files.pictures import split_layer
from ...files.temporary import temporary_folder
from ...host.bake_settings import (
    EXTENSION,
    baked_folder,
    blender_program,
    check_choices,
    check_object,
    chosen_environment,
    existing,
    open_file,
    own_material,
    plain_settings,
    save_copy,
)
from ...host.materials import ORIGINAL, fingerprint
from ...host.version import software
from ...host.worlds import world_of
from ...job import BakeJob
from ..compare.compare import truth_of
from ..methods.methods import METHODS, Lobes, Method, measured_spec
from .background import Bake, blender_command

HASH_LETTERS = 10
"""Of a file's name: enough to tell a million bakes apart."""

NAME_LETTERS = 50
"""Of a file's name at most, for people: a letter may take 4 bytes of 255."""

COMPARED_VIEWS = 6
"""From so many sides a map set is compared with the truth."""


@dataclass(frozen=True)
class Order:
    """What is to be baked.

    Attributes
    ----------
    environment : str or None
        None for the world of the open file.
    method : Method
    own_material : str or None
        Name of the material, where it is one of the open file.
    measured : str or None
        Path of the file that holds the material, where there is one.
    clamp : float
        The greatest radiance of the environment that is kept; 0 for all.
    settings : dict
        All that the scene says, to bake the same again.
    """

    environment: str | None
    method: Method
    own_material: str | None
    measured: str | None
    clamp: float
    settings: dict[str, Any]

    @property
    def needs_file(self) -> bool:
        """Whether the world or the material are those of the open file."""
        return self.environment is None or self.own_material is not None

    @property
    def title(self) -> str:
        """What is baked, in words."""
        light = "the world" if self.environment is None else split_layer(self.environment)[0].stem
        return f"{self.method.subject or self.method.kind.replace('_', ' ')} in {light}"

    def job(self, output: Path) -> BakeJob:
        """What makes `output`, and replaces what is there: that is damaged, or it would not be made."""
        light = () if self.environment is None else ("--environment", self.environment)
        return BakeJob((*self.arguments(), *light, "--output", str(output), "--force"))

    def arguments(self) -> tuple[str, ...]:
        """Of the command line, without environment and output."""
        return *self.method.arguments(), *(("--clamp", f"{self.clamp:g}") if self.clamp else ())


@dataclass
class ObjectBake(Bake):
    """A bake for objects.

    Attributes
    ----------
    items : list of int
        The objects' `session_uid`.
    settings : dict
        Of the order; empty where what it makes shades nothing.
    reads : ExitStack
        Removes what the bake reads.
    """

    settings: dict[str, Any] = field(default_factory=dict)
    items: list[int] = field(default_factory=list)
    reads: ExitStack = field(default_factory=ExitStack, repr=False)

    def tidy(self) -> None:
        """Remove what it has read, once it has ended."""
        self.reads.close()


def order_for(scene: Any, item: Any) -> Order:
    """Read the settings for an object.

    Parameters
    ----------
    scene : bpy.types.Scene
        Holds `ui.bake_properties.RSIBR_PG_bake`.
    item : bpy.types.Object or None

    Returns
    -------
    Order

    Raises
    ------
    SceneError, InputFileError
        Something is missing; says what to do.
    """
    check_object(item)
    check_choices(scene.rsibr_bake)
    chosen = getattr(scene.rsibr_bake, scene.rsibr_bake.kind)
    check_choices(chosen)
    source = getattr(chosen, "source", None)
    own = own_material(item).name if source == "OWN" else None
    measured = existing(chosen.path, "measured material", "its file") if source == "FILE" else None
    environment = chosen_environment(scene)
    method = METHODS[scene.rsibr_bake.kind](chosen, own or measured or "")
    clamp = scene.rsibr_bake.clamp
    return Order(environment, method, own, measured, clamp, plain_settings(scene.rsibr_bake))


def output_for(order: Order, scene: Any, item: Any) -> Path:
    """The file that an order makes: the same order has the same file, a different one another.

    Parameters
    ----------
    order : Order
        Of `scene` and `item`.
    scene : bpy.types.Scene
    item : bpy.types.Object

    Returns
    -------
    Path
        Its name tells what it depends on, by a hash: method, light, material, version.

    Raises
    ------
    OutputFileError
        Its folder cannot be made.
    """
    content = {
        "method": order.arguments(),
        "light": fingerprint(world_of(scene)) if order.environment is None else _light(order.environment),
        "material": fingerprint(own_material(item)) if order.own_material else None,
        "measured": _digest(order.measured) if order.measured else None,
        "software": software(),
    }
    letters = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:HASH_LETTERS]
    words = re.sub(r"[^\w.-]+", "-", order.title.lower())[:NAME_LETTERS]
    return baked_folder() / f"{words}-{letters}.rsibr.exr"


def is_baked(output: Path) -> bool:
    """Whether a file is there, and a map set that is whole."""
    try:
        read_map_set(output)
    except MapSetError:
        return False
    return True


def bake_of(order: Order, item: Any, output: Path) -> ObjectBake:
    """Make everything ready that a background Blender needs to bake.

    Parameters
    ----------
    order : Order
    item : bpy.types.Object
        That is to be shaded from the map set.
    output : Path

    Returns
    -------
    ObjectBake
        To be added to a queue.

    Raises
    ------
    SceneError
        This is no Blender that could be started again.
    OutputFileError
        The open file cannot be copied.
    """
    bake = _in_background(f"{item.name}: {order.title}", order.job(output), item, output, order.needs_file)
    bake.settings = order.settings
    return bake


def comparison_of(item: Any, map_set: Path) -> ObjectBake:
    """Make everything ready to compare an object's map set with the truth.

    Parameters
    ----------
    item : bpy.types.Object
    map_set : Path

    Returns
    -------
    ObjectBake
        Whose output is a report in the folder NAME-compared beside NAME.rsibr.exr.

    Raises
    ------
    MapSetError
        The file is none, or of a kind that nothing is compared with.
    SceneError, OutputFileError
        See `bake_of`.
    """
    truth_of(map_set)
    folder = comparison_beside(map_set)
    views = ("--views", str(COMPARED_VIEWS))
    job = BakeJob(("compare", str(map_set), *views, *_named_model(item), "--output", str(folder), "--force"))
    return _in_background(f"{item.name}: comparison", job, item, folder / "index.html", True)


def _named_model(item: Any) -> tuple[str, ...]:
    """The model that the artist chose for a bake: no file is opened because a map set alone names it."""
    if not item.is_property_set("rsibr_baked") or item.rsibr_baked.kind != Lobes.kind:
        return ()
    chosen = getattr(item.rsibr_baked, Lobes.kind)
    match chosen.source:
        case "FILE":
            return "--brdf", measured_spec(existing(chosen.path, "measured material", "its file"))
        case "MODEL":
            return "--brdf", chosen.brdf
        case _:
            return ()


def _in_background(title: str, job: BakeJob, item: Any, output: Path, needs_file: bool) -> ObjectBake:
    program = blender_program()
    if not program:
        raise SceneError("There is no Blender to bake in: bake with the command rsibr instead.")
    with ExitStack() as stack:
        folder = stack.enter_context(temporary_folder())
        path = folder / "job.json"
        path.write_text(job.to_json(), encoding="utf-8")
        blend = folder / "open.blend" if needs_file else None
        if blend is not None:
            save_copy(blend)
        reads = stack.pop_all()
    return ObjectBake(
        title=title,
        output=output,
        command=blender_command(program, EXTENSION, blend, path),
        # What its Blender leaves, ended amid its start, goes with the folder
        variables={ORIGINAL: open_file(), "TMPDIR": str(folder)},
        items=[item.session_uid],
        reads=reads,
    )


def _light(environment: str) -> str:
    file, layer = split_layer(environment)
    return _digest(file) + (f":{layer}" if layer else "")


def _digest(path: str | Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()

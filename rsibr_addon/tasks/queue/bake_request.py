"""Bakes of what the artist has chosen: the request, its file, and the job in the background."""

import re
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

from ...core.errors import SceneError
from ...core.options import declared_options, value_text
from ...files.kinds.registry import STORED
from ...files.output_paths import HASH_LETTERS, comparison_beside, comparison_page, portable_name
from ...files.pictures import split_layer
from ...files.temporary import temporary_folder
from ...host.bake_settings import check_choices, check_object, chosen_environment, existing, own_material
from ...host.blend_files import path_of_open, save_copy
from ...host.installation import blender_program
from ...host.materials import ORIGINAL, fingerprint
from ...host.option_properties import FILE, OWN, options_of
from ...host.plain_settings import plain_settings
from ...host.preferences import EXTENSION, baked_folder, make_writable
from ...host.shape_dependence import shape_dependence
from ...host.world_light import world_light
from ...job import BakeJob, CommandJob
from ...settings.light import Clamp, Light
from ...settings.method import MethodSettings
from ..compare.compare import truth_of
from ..methods.bake import METHODS
from ..methods.kinds import KINDS
from ..methods.method import Cost
from ..methods.recipe import light_hash, make_recipe, recipe_hash
from ..report.facts import map_set_header
from .background import Bake, Farm, blender_command

NAME_LETTERS = 50
"""Greatest length of the words in a file's name: a letter may take 4 of its 255 bytes."""

COMPARED_VIEWS = 6
"""From so many sides a map set is compared with the truth."""


@dataclass(frozen=True)
class BakeRequest:
    """What to bake.

    Attributes
    ----------
    settings : MethodSettings
    light : Light
        Without an environment, the world of the open file.
    own_material : str or None
        Name of the material, where it is one of the open file.
    shown : dict
        All that the scene says, to bake the same again.
    remarks : tuple of str
        What the map set will lack, as far as it is known beforehand.
    """

    settings: MethodSettings
    light: Light
    own_material: str | None
    shown: dict[str, Any]
    remarks: tuple[str, ...] = ()

    @property
    def needs_file(self) -> bool:
        """Whether the world or the material comes from the open file."""
        return self.light.environment is None or self.own_material is not None

    def makes_the_same(self, other: "BakeRequest") -> bool:
        """Whether another request of the same object, scene and moment makes the same map set."""
        made, others = ((each.settings, each.light, each.own_material) for each in (self, other))
        return made == others

    @property
    def title(self) -> str:
        """What is baked, in words."""
        what = METHODS[self.settings.KIND].material(self.settings) or self.settings.LABEL.lower()
        return f"{what} in {self._light_name}"

    def title_for(self, shaded: str) -> str:
        """What is baked for these objects, in words that fit into a line of the panel."""
        own = KINDS[self.settings.KIND].own
        return f"{shaded} in {self._light_name}" if own else f"{shaded}: {self.title}"

    @property
    def _light_name(self) -> str:
        environment = self.light.environment
        return "the world" if environment is None else split_layer(environment)[0].stem

    @property
    def cost(self) -> Cost:
        """What it will take."""
        return METHODS[self.settings.KIND].cost(self.settings)

    def job(self, output: Path) -> BakeJob[Any]:
        """The job that makes `output`. It replaces a file that is there now: a whole one would be used."""
        damaged = output.exists()
        return BakeJob(self.settings, str(output), self.light, damaged, if_missing=not damaged)


@dataclass
class ObjectBake(Bake):
    """A bake for objects.

    Attributes
    ----------
    items : list of int
        The objects' `session_uid`.
    settings : dict
        Settings of the request; empty if what it makes shades nothing.
    reads : ExitStack
        Removes what the bake reads.
    by_itself : bool
        Whether nobody asked for it, so that nobody undoes it.
    """

    settings: dict[str, Any] = field(default_factory=dict)
    items: list[int] = field(default_factory=list)
    reads: ExitStack = field(default_factory=ExitStack, repr=False)
    by_itself: bool = False

    def tidy(self) -> None:
        """Remove its input files after it has ended."""
        self.reads.close()


Made = TypeVar("Made", bound=ObjectBake)


def request_for(chosen: Any, scene: Any, item: Any, kind: str = "") -> BakeRequest:
    """Read settings for an object.

    Parameters
    ----------
    chosen : RSIBR_PG_bake
        Settings of the scene, or those that an object was baked with.
    scene : bpy.types.Scene
        Has the world.
    item : bpy.types.Object or None
    kind : str
        Kind of map sets to make instead of the one that is chosen.

    Raises
    ------
    SceneError, InputFileError, RangeError
        Something is missing, or cannot be; says what to do.
    """
    check_object(item)
    check_choices(chosen)
    kind = kind or chosen.kind
    of_kind = getattr(chosen, kind)
    check_choices(of_kind)
    source = getattr(of_kind, "source", None)
    material = own_material(item) if source == OWN else None
    own = material.name if material else None
    if source == FILE:
        existing(of_kind.path, "measured material", "its file")
    settings = options_of(STORED[kind].settings, of_kind, own or "")
    environment, clamp = chosen_environment(chosen, scene), options_of(Clamp, chosen).clamp
    # A material's emission would follow the world too
    follows = environment is None and own is None and item.rsibr.follow_world
    bare = follows and world_light(scene.world) is not None
    light = Light(environment=environment, clamp=clamp, bare_world=bare)
    shown = plain_settings(chosen) | {"kind": kind, "bare_world": bare}
    request = BakeRequest(settings, light, own, shown, _remarks(material))
    _ = request.cost  # which a text that describes no model has not
    return request


def output_for(request: BakeRequest, scene: Any, item: Any) -> Path:
    """The file that a request makes: the same request has the same file, a different one another.

    Parameters
    ----------
    request : BakeRequest
        The request of `scene` and `item`.
    scene : bpy.types.Scene
    item : bpy.types.Object

    Returns
    -------
    Path
        Its name tells what it depends on, by a hash: method, light, material, version.
    """
    sources = METHODS[request.settings.KIND].sources(request.settings)
    material = fingerprint(own_material(item)) if request.own_material else None
    light = light_hash(request.light, scene)
    recipe = make_recipe(request.settings, request.light, light, sources, material)
    letters = recipe_hash(recipe)[:HASH_LETTERS]
    words = portable_name(request.title.lower())[:NAME_LETTERS]
    return baked_folder() / f"{words}-{letters}.rsibr.exr"


def plain_name(map_set: Path) -> str:
    """The name of a map set's file for people: without the hash of `output_for`, if it has one."""
    return re.sub(rf"-[0-9a-f]{{{HASH_LETTERS}}}\.rsibr\.exr$", "", map_set.name)


def bake_of(
    request: BakeRequest, scene: Any, items: Sequence[Any], output: Path, farm: Farm | None = None
) -> ObjectBake:
    """Make everything ready that a background Blender needs to bake, or to have a farm bake.

    Parameters
    ----------
    request : BakeRequest
        The request of `scene` and each of `items`.
    scene : bpy.types.Scene
    items : sequence of bpy.types.Object
        The objects that the map set will shade.
    output : Path
    farm : Farm, optional

    Returns
    -------
    ObjectBake
        To be added to a queue.

    Raises
    ------
    SceneError
        This is no Blender that could be started again.
    OutputFileError
        The open file cannot be copied, or nothing can be written to the output's folder.
    """
    make_writable(output.parent)
    shaded = items[0].name if len(items) == 1 else f"{len(items)} objects"
    job = request.job(output)
    needed = scene if request.needs_file else None
    bake = in_background(request.title_for(shaded), job, needed, items, output, ObjectBake, farm)
    bake.settings = request.shown
    return bake


def comparison_of(scene: Any, item: Any, map_set: Path) -> ObjectBake:
    """Make everything ready to compare the map set of an object of a scene with the truth.

    Returns
    -------
    ObjectBake
        Its output is a report in the folder NAME-compared beside NAME.rsibr.exr.

    Raises
    ------
    MapSetError
        The file is none, or of a kind that nothing is compared with.
    SceneError, OutputFileError
        See `bake_of`; or the object is shaded with its own materials.
    """
    shown = shown_material(item, map_set)
    folder = comparison_beside(map_set)
    views = ("--views", str(COMPARED_VIEWS))
    job = CommandJob(
        ("compare", str(map_set), *views, *shown, *_named_model(item), "--output", str(folder), "--force")
    )
    page = comparison_page(map_set)
    return in_background(f"{item.name}: comparison", job, scene, [item], page, ObjectBake)


def shown_material(item: Any, map_set: Path) -> tuple[str, ...]:
    """What `rsibr compare` is to know of the material that an object shows from a map set.

    Raises
    ------
    MapSetError
        See `comparison_of`.
    SceneError
        The object is shaded with its own materials.
    """
    truth_of(map_set)
    kind = map_set_header(map_set)["kind"]
    stored = STORED[kind]
    look: Any = options_of(stored.look, getattr(item.rsibr, kind))
    if KINDS[kind].own and look.own:
        raise SceneError(
            f"Object {item.name} is shaded with its own materials, which have no reflectance to sum: switch "
            f"Own Materials off to compare one material, or look at Difference."
        )
    compared = declared_options(stored.comparison) if stored.comparison else ()
    looks = {each.name for each in declared_options(stored.look)}
    given = [(each.flag, getattr(look, each.name)) for each in compared if each.name in looks]
    return tuple(text for flag, value in given if value is not None for text in (flag, value_text(value)))


def _named_model(item: Any) -> tuple[str, ...]:
    """The model that the artist chose for a bake: no file is opened because a map set alone names it."""
    if not item.is_property_set("rsibr_baked"):
        return ()
    stored = STORED[item.rsibr_baked.kind]
    chosen = getattr(item.rsibr_baked, item.rsibr_baked.kind)
    models = [
        each
        for each in declared_options(stored.settings)
        if each.option.materials and each.option.materials.model
    ]
    if stored.comparison is None or getattr(chosen, "source", OWN) == OWN:
        return ()
    compared = {each.name for each in declared_options(stored.comparison)}
    settings = options_of(stored.settings, chosen)
    given = [(each.flag, getattr(settings, each.name)) for each in models if each.name in compared]
    return tuple(text for flag, value in given if value is not None for text in (flag, value))


def in_background(
    title: str,
    job: BakeJob[Any] | CommandJob,
    scene: Any,
    items: Sequence[Any],
    output: Path,
    made: type[Made],
    farm: Farm | None = None,
) -> Made:
    """Make everything ready for a job in a background Blender.

    Parameters
    ----------
    title : str
        What is made, for people.
    job : BakeJob or CommandJob
    scene : bpy.types.Scene or None
        The scene that the job needs open, if any.
    items : sequence of bpy.types.Object
        What it is made for.
    output : Path
    made : type
        Of the bake that is returned.
    farm : Farm, optional
        Does the job.

    Raises
    ------
    SceneError
        This is no Blender that could be started again.
    OutputFileError
        The open file cannot be copied.
    """
    program = blender_program()
    if not program:
        raise SceneError("There is no Blender to bake in: bake with the command rsibr instead.")
    with ExitStack() as stack:
        folder = stack.enter_context(temporary_folder())
        path = folder / "job.json"
        path.write_text(job.to_json(), encoding="utf-8")
        opened = None if scene is None else (folder / "open.blend", scene.name)
        if opened is not None:
            save_copy(opened[0], scene)
        reads = stack.pop_all()
    return made(
        title=title,
        output=output,
        command=blender_command(program, EXTENSION, opened, path, farm),
        # What a Blender leaves that is ended while it starts goes with the folder
        variables={ORIGINAL: path_of_open(), "TMPDIR": str(folder)},
        items=[item.session_uid for item in items],
        elsewhere=farm is not None,
        reads=reads,
    )


def _remarks(material: Any) -> tuple[str, ...]:
    reasons = "; ".join(shape_dependence(material)) if material else ""
    return (f"{material.name} is baked as it looks on one shape: {reasons}.",) if reasons else ()

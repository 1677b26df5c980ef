"""Recipes of map sets: an equal bake is known by its recipe, and what differs is told from it."""

import hashlib
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ...core.brdf.cycles_presets import PRESETS
from ...core.brdf.spec import MATERIAL
from ...core.errors import MapSetError, OutputFileError
from ...core.options import declared_options, to_plain
from ...files.baked_inputs import is_whole
from ...files.digests import digest
from ...files.kinds.registry import STORED
from ...files.map_set import is_whole_map_set, read_map_set_header
from ...files.map_set_facts import in_words
from ...files.map_set_header import Recipe
from ...files.pictures import split_layer
from ...files.version import rsibr
from ...job import BakeJob
from ...settings.baked_inputs import ObjectInputsSettings
from ...settings.light import Light
from ...settings.method import MethodSettings
from ..light.environments import environment_file
from .method import Sources

CHANGED = {
    "light": "another environment",
    "material": "another material",
    "files": "other files of the material",
}
"""Field of a recipe whose values are hashes -> what to say of it."""

_NOT_WHOLE = "exists, but is no whole map set: give another name, or --force to replace it."

_PLACES = (
    (
        rf"(^|\bpath\s*=\s*|^{MATERIAL}:\s*)",
        r"(?=\s*(?:$|\))|(?:(?<=(?i:\.blend))|(?<=(?i:\.blend\d))):)",
    ),
    (r"(\blight\s*=\s*)", r"(?=\s*(?:[,;]|$))"),
)
"""What comes before and after a file in settings: in those of a material, and in a probe."""


def recipe_of(job: BakeJob[Any], sources: Sources) -> Recipe:
    """The recipe of a job.

    Parameters
    ----------
    job : BakeJob
        Its world and material are those of the open file, where it names none.
    sources : Sources
        Of its settings.

    Raises
    ------
    InputFileError
        A file cannot be read, or there is no environment or material of that name.
    SceneError
        The world or the material cannot be used.
    """
    return make_recipe(job.settings, job.light, light_hash(job.light), sources, _material_hash(sources))


def make_recipe(
    settings: MethodSettings, light: Light, light_hash: str, sources: Sources, material: str | None
) -> Recipe:
    """A recipe, of hashes of what Blender holds.

    Parameters
    ----------
    settings : MethodSettings
    light : Light
    light_hash : str
        See `light_hash`.
    sources : Sources
        Of the settings.
    material : str or None
        Fingerprint of the material of `sources`; None where it is none of a file.

    Raises
    ------
    InputFileError
        A file cannot be read.
    """
    return Recipe(
        kind=settings.KIND,
        settings=_without_folders(to_plain(settings), sources),
        clamp=light.clamp,
        light=light_hash,
        material=material,
        files=[digest(file) for file in sources.named.values()],
        software=_software(light, sources),
    )


def light_hash(light: Light, scene: Any = None) -> str:
    """What `Recipe.light` holds.

    Parameters
    ----------
    light : Light
    scene : bpy.types.Scene, optional
        Has the world; by default the one that the artist works in.

    Raises
    ------
    InputFileError, SceneError
        See `recipe_of`.
    """
    if light.environment is not None:
        file, layer = split_layer(environment_file(light.environment))
        return digest(file) + (f":{layer}" if layer else "")
    from ...host.materials import fingerprint, node_fingerprint
    from ...host.scenes import find_scene
    from ...host.world_light import environment_texture
    from ...host.worlds import world_of

    world = world_of(scene or find_scene(None))
    return f"bare {node_fingerprint(environment_texture(world))}" if light.bare_world else fingerprint(world)


def recipe_hash(recipe: Recipe) -> str:
    """64 hexadecimal digits, equal for equal recipes."""
    return hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()


def with_files_named(settings: dict[str, Any], names: Mapping[str, str]) -> dict[str, Any]:
    """Settings that give other names to files.

    Parameters
    ----------
    settings : dict
        JSON values. A file is a whole text, or stands in one as ``path=FILE``, ``light=FILE`` or
        ``FILE.blend:NAME``.
    names : mapping of str to str
        A file as the settings name it -> its other name.
    """

    def named(value: Any) -> Any:
        for file, name in names.items() if isinstance(value, str) else ():
            for begin, end in _PLACES:
                place = re.compile(f"{begin}{re.escape(file)}{end}")
                value = place.sub(r"\g<1>" + name.replace("\\", r"\\"), value)
        return value

    return {option: named(value) for option, value in settings.items()}


def check_made_by(path: Path, wanted: Recipe, known_whole: bool = False) -> None:
    """Refuse a damaged file, and one that was not made by a recipe, which baked inputs do not state.

    Parameters
    ----------
    path : Path
    wanted : Recipe
    known_whole : bool
        Whether a map set has been read since it was written, so that its description is enough.

    Raises
    ------
    OutputFileError
        Says what differs, or that the file does not tell.
    """
    if wanted["kind"] == ObjectInputsSettings.KIND:
        if not is_whole(path):
            raise OutputFileError(
                f"{path} exists, but holds no baked inputs: give another name, or --force to replace it."
            )
        return
    try:
        header = read_map_set_header(path)
    except MapSetError as error:
        raise OutputFileError(f"{path} {_NOT_WHOLE}") from error
    if "recipe" not in header:
        raise OutputFileError(
            f"{path} exists, and does not tell the settings it was made with, as files of older versions do "
            f"not: give another name, or --force to replace it."
        )
    if differences := "; ".join(_differences(header["recipe"], wanted)):
        raise OutputFileError(
            f"{path} exists, made with other settings ({differences}): give another name, or --force to "
            f"replace it."
        )
    if not known_whole and not is_whole_map_set(path):
        raise OutputFileError(f"{path} {_NOT_WHOLE}")


def _differences(there: Recipe, wanted: Recipe) -> Iterator[str]:
    """What differs from what is there, in words."""
    if there["kind"] != wanted["kind"]:
        yield f"{in_words(there['kind'])}, not {in_words(wanted['kind']).lower()}"
        return
    for each in declared_options(STORED[wanted["kind"]].settings):
        # Another version may have had other options
        old, new = there["settings"].get(each.name), wanted["settings"][each.name]
        if old != new:
            yield f"{each.option.label} {_told(old)}, not {_told(new)}"
    if there["clamp"] != wanted["clamp"]:
        yield f"Clamp {_told(there['clamp'])}, not {_told(wanted['clamp'])}"
    yield from (said for field, said in CHANGED.items() if there.get(field) != wanted.get(field))
    if there["software"] != wanted["software"]:
        yield f"{there['software']}, not {wanted['software']}"


def _told(value: Any) -> str:
    return "none" if value is None else str(value)


def _without_folders(settings: dict[str, Any], sources: Sources) -> dict[str, Any]:
    """Settings in which files have their names alone: machines have the same file in different folders."""
    names = {named: file.name for named, file in sources.named.items()}
    if sources.material is not None and sources.material not in PRESETS:
        from ...host.materials import material_file

        if blend := material_file(sources.material):
            names[blend] = Path(blend).name
    return with_files_named(settings, names)


def _software(light: Light, sources: Sources) -> str:
    if light.environment is not None and sources.material is None:
        return rsibr()
    from ...host.version import software

    return software()


def _material_hash(sources: Sources) -> str | None:
    if sources.material is None or sources.material in PRESETS:
        return None
    from ...host.materials import fingerprint, load_material
    from ...host.scenes import temporary_scene

    with temporary_scene():
        return fingerprint(load_material(sources.material))

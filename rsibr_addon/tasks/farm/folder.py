"""A folder that holds a batch and all that it needs, for machines that have nothing else."""

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ...core.brdf.cycles_presets import PRESETS
from ...core.errors import InputFileError, RangeError, SceneError, SchemaError
from ...core.progress import Progress, Steps
from ...core.schema import loads
from ...core.warned import warn
from ...files.atomic import written_aside
from ...files.digests import digest
from ...files.output_paths import HASH_LETTERS, portable_name
from ...files.outputs import make_folder
from ...files.pictures import split_layer
from ...files.reading import read_text
from ...job import OBJECT, BakeJob, job_of_object, read_job
from ...settings.baked_inputs import ObjectInputsSettings
from ..batch.bake_list import HERE, bake_list_text
from ..batch.bakes import BatchBake, Opened
from ..batch.description import is_pattern, read_batch
from ..batch.faults import fault_of
from ..light.environments import environment_file
from ..methods.bake import METHODS, recipe_for
from ..methods.method import Sources
from ..methods.recipe import recipe_hash, with_files_named

INPUTS, MAPS = "inputs", "maps"
"""Folders within the farm's folder."""


def bakes_to_send(path: Path) -> tuple[str, Path, list[BatchBake]]:
    """The bakes of a batch, or the one of a job.

    Parameters
    ----------
    path : Path
        BATCH.json or BATCH.csv, or JOB.json.

    Returns
    -------
    title : str
        What is sent, for people.
    folder : Path
        Where their outputs are meant to be.
    bakes : list of BatchBake
        With outputs relative to it.

    Raises
    ------
    InputFileError
        See `read_batch`; or an output lies outside the batch's folder, or is that of several objects; or a
        list names files outside its folder.
    SceneError
        A job's pattern means no object.
    """
    job = _read_job(path)
    if job is not None:
        bakes = [_bake_of(each) for each in _jobs_of(job)]
        _check_lists(bakes)
        title = bakes[0].title if len(bakes) == 1 else path.stem
        return title, Path(job.output).parent, bakes
    bakes = []
    for each in read_batch(path):
        output = os.path.relpath(each.job.output, path.parent)
        if output.startswith(os.pardir) or os.path.isabs(output):
            raise InputFileError(
                f"{path} makes {each.job.output}, which other machines may not have: give outputs in the "
                f"batch's folder."
            )
        bakes.append(replace(each, job=replace(each.job, output=Path(output).as_posix())))
    _check_lists(bakes)
    return path.stem, path.parent, bakes


def folder_name(title: str, bakes: Sequence[BatchBake]) -> str:
    """A name that equal batches have in common, and no others: so what they have made is found again.

    Parameters
    ----------
    title : str
    bakes : sequence of BatchBake
        From `bakes_to_send`.

    Warns
    -----
    RsibrWarning
        A bake will fail, and why, unless `fault_of` says it.
    """
    identities = [(bake.job.output, _identity(bake)) for bake in bakes]
    letters = hashlib.sha256(json.dumps(identities).encode()).hexdigest()[:HASH_LETTERS]
    return f"{batch_name(title)}-{letters}"


def batch_name(title: str) -> str:
    """What a batch of a title is called on a farm."""
    return portable_name(title) or "batch"


def write_inputs(folder: Path, name: str, bakes: Sequence[BatchBake]) -> Steps[list[BatchBake]]:
    """Copy all that bakes need into a folder, and list the bakes there.

    Parameters
    ----------
    folder : Path
        It exists. Copies that are there already stay; files of Blender are packed anew, as what they use may
        have changed.
    name : str
        The list becomes NAME.json.
    bakes : sequence of BatchBake
        From `bakes_to_send`.

    Returns
    -------
    list of BatchBake
        The same, with paths of the folder, which begin with `HERE`.

    Raises
    ------
    InputFileError, SceneError, OutputFileError

    Warns
    -----
    RsibrWarning
        See `host.packing.write_packed`.

    Notes
    -----
    Files keep their names, which recipes state. Files of Blender take along what they use.
    """
    copied = _Copies(folder)
    # First what means the open file, as packing another one closes it
    order = sorted(range(len(bakes)), key=lambda number: not _means_open_file(bakes[number]))
    found: dict[int, BatchBake] = {}
    for done, number in enumerate(order):
        yield Progress(done, len(bakes), f"copying what {bakes[number].title} needs")
        found[number] = copied.placed(bakes[number])
    placed = [found[number] for number in range(len(bakes))]
    with written_aside(folder / f"{name}.json", force=True) as aside:
        aside.write_text(bake_list_text(placed), encoding="utf-8")
    return placed


class _Copies:
    """What was copied into a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._made: set[str] = set()

    def placed(self, bake: BatchBake) -> BatchBake:
        """A bake with paths of the folder; as it is, where it cannot be done anywhere."""
        job, opened = bake.job, bake.opened
        try:
            sources = _sources(bake)
            if sources.listed:
                replaced = {sources.files[0]: self._copy_list(Path(sources.files[0]), sources.listed)}
            else:
                replaced = {named: self._copy(file) for named, file in sources.named.items()}
            if blend := _blend_file(sources.material):
                replaced[blend] = self._packed(Path(blend))
            light = job.light
            if light.environment is not None:
                file, layer = split_layer(environment_file(light.environment))
                named = self._copy(file) + (f":{layer}" if layer else "")
                light = replace(light, environment=named)
        except InputFileError:
            return bake
        if _means_open_file(bake):
            opened = Opened(self._once("open.blend", _write_open_file), _open_path())
        settings = _with_texts(job, replaced)
        return replace(bake, job=replace(settings, light=light), opened=opened)

    def _copy(self, file: Path) -> str:
        return self._once(f"{digest(file)[:HASH_LETTERS]}/{file.name}", partial(_copy, file))

    def _copy_list(self, file: Path, listed: Sequence[str]) -> str:
        """A list beside what it names, so that its names hold."""
        files = {name: file.parent / name for name in (file.name, *listed)}
        digests = [digest(each) for each in files.values()]
        letters = hashlib.sha256("".join(digests).encode()).hexdigest()[:HASH_LETTERS]
        copies = [self._once(f"{letters}/{name}", partial(_copy, each)) for name, each in files.items()]
        return copies[0]

    def _packed(self, file: Path) -> str:
        def pack(target: Path) -> None:
            from ...host.blend_files import open_blend

            open_blend(file)
            _write_packed(target)

        return self._once(f"{digest(file)[:HASH_LETTERS]}/{file.name}", pack)

    def _once(self, name: str, write: Callable[[Path], None]) -> str:
        """The path of a copy within the list; it is written once."""
        if name not in self._made:
            target = self._folder / name
            make_folder(target.parent)
            write(target)
            self._made.add(name)
        return f"{HERE}/{name}"


def _copy(file: Path, target: Path) -> None:
    if not target.exists():
        with written_aside(target) as aside:
            shutil.copyfile(file, aside)


def _open_path() -> str:
    from ...host.materials import open_path

    return open_path()


def _write_open_file(target: Path) -> None:
    from ...host.blend_files import is_file_open

    if not is_file_open():
        raise SceneError(
            "No file is open whose world or material could be sent: open it by blender -b FILE.blend."
        )
    _write_packed(target)


def _write_packed(target: Path) -> None:
    from ...host.packing import write_packed

    with written_aside(target, force=True) as aside:
        write_packed(aside)


def _with_texts(job: BakeJob[Any], replaced: dict[str, str]) -> BakeJob[Any]:
    """A job whose settings name other files."""
    plain = json.loads(job.to_json())
    plain["settings"] = with_files_named(plain["settings"], replaced)
    made = read_job(json.dumps(plain), "The job")
    assert isinstance(made, BakeJob)
    return made


def _check_lists(bakes: Sequence[BatchBake]) -> None:
    """Refuse lists of files whose names mean nothing elsewhere."""
    for sources in map(_sources, bakes):
        for name in map(Path, sources.listed):
            if name.is_absolute() or os.pardir in name.parts:
                raise InputFileError(
                    f"{sources.files[0]} names {name}, which other machines may not have: put it beside the "
                    f"list, and name it relative to the list's folder."
                )


def _identity(bake: BatchBake) -> str:
    try:
        return recipe_hash(recipe_for(bake.job))
    except (InputFileError, RangeError, SceneError) as error:
        if not fault_of(bake):
            warn(f"{bake.title} will fail: {error}")
        return bake.job.to_json()


def _means_open_file(bake: BatchBake) -> bool:
    material = _sources(bake).material
    return bake.job.light.environment is None or (material is not None and material.startswith(":"))


def _sources(bake: BatchBake) -> Sources:
    """What a bake's settings take from elsewhere; nothing where they describe no material."""
    try:
        return METHODS[bake.job.settings.KIND].sources(bake.job.settings)
    except RangeError:
        return Sources()


def _blend_file(material: str | None) -> str:
    """The file of Blender that a material is in; empty for a preset and the open file."""
    if material is None or material in PRESETS:
        return ""
    from ...host.materials import material_file

    return material_file(material)


def _read_job(path: Path) -> BakeJob[Any] | None:
    """The job in a file; None where it is another file."""
    try:
        text = read_text(path)
        plain = loads(text) if path.suffix.lower() == ".json" else None
    except (SchemaError, UnicodeDecodeError):
        return None
    if not isinstance(plain, dict) or not {"settings", "arguments"} & plain.keys():
        return None
    job = read_job(text, str(path))
    if not isinstance(job, BakeJob):
        raise InputFileError(
            f"{path} is the job of rsibr {job.arguments[0]}, which a farm does not do: send a batch, or the "
            f"job of a bake."
        )
    return job


def _jobs_of(job: BakeJob[Any]) -> list[BakeJob[Any]]:
    """The job, or one for each object that its pattern means."""
    if job.settings.KIND != ObjectInputsSettings.KIND:
        return [job]
    names = [job.settings.object]
    if is_pattern(job.settings.object):
        from ..baked_inputs import objects_to_bake

        names = objects_to_bake(job.settings.object)
    jobs: dict[str, BakeJob[Any]] = {}
    for name in names:
        named = job_of_object(job, name)
        if named.output in jobs:
            raise InputFileError(
                f"{named.output} is the output of {jobs[named.output].settings.object} and of {name}: tell "
                f"objects apart by {OBJECT} in it."
            )
        jobs[named.output] = named
    return list(jobs.values())


def _bake_of(job: BakeJob[Any]) -> BatchBake:
    environment = job.light.environment
    if job.settings.KIND == ObjectInputsSettings.KIND:
        light = Path(_open_path()).stem or "scene"
    else:
        light = "world" if environment is None else split_layer(environment)[0].stem
    material = METHODS[job.settings.KIND].material(job.settings)
    return BatchBake(
        light, material, replace(job, output=Path(job.output).name, force=False, if_missing=True)
    )

"""What a batch is, and the bakes that it stands for."""

import os
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Literal

from ...core.brdf.cycles_presets import PRESETS
from ...core.brdf.gallery import GALLERY
from ...core.errors import InputFileError, RangeError, SchemaError
from ...core.options import Declared, declared_options
from ...core.schema import decode, loads
from ...files.kinds.registry import STORED
from ...files.measured_files import MEASURED_FORMATS, measured_spec
from ...files.output_paths import portable_name
from ...files.pictures import split_layer
from ...files.reading import read_text
from ...job import BakeJob
from ...settings.light import Light
from .bake_list import bakes_of_list, is_bake_list
from .bakes import BatchBake
from .table import method_kind, rows_of

OUTPUT = "{environment}-{material}.rsibr.exr"
"""Pattern of outputs where a batch gives none."""

FIELDS = ("environment", "material", "method", "size")
"""What a pattern may name."""

_BLEND = re.compile(r"(.+?\.blend\d*):(.+)", re.IGNORECASE)
_PATH = re.compile(r"\bpath\s*=\s*([^,]*[^,\s])")  # of a measurement
_LIGHT = re.compile(r"\blight\s*=\s*([^,;]+)")  # of a probe
_MODELS = {name: text for models in GALLERY.values() for name, text in models.items()}


@dataclass(frozen=True)
class _Batch:
    """All of some environments, methods and materials; see docs/batches.md."""

    environments: tuple[str, ...]
    methods: tuple[str | dict[str, Any], ...]
    materials: tuple[str, ...] = ()
    sizes: tuple[int, ...] = ()
    output: str = OUTPUT
    clamp: float | None = None
    format: Literal[1] = field(default=1, kw_only=True)


def read_batch(path: Path, folder: Path | None = None) -> list[BatchBake]:
    """The bakes of a batch, those in the same environment behind each other.

    Parameters
    ----------
    path : Path
        BATCH.json, or BATCH.csv. What it names is looked for beside it.
    folder : Path, optional
        Where outputs go; by default beside it too.

    Raises
    ------
    InputFileError
        The file is missing or no batch, a pattern finds nothing, or two bakes would have one output.
    """
    folder = path.parent if folder is None else folder
    try:
        # Patterns may overlap, and so mean a bake twice
        read = _read(read_text(path), path, folder)
        found = list({(bake.job.to_json(), bake.opened): bake for bake in read}.values())
        _check(found, path)
    except UnicodeDecodeError as error:
        raise InputFileError(f"{path} is no text: give a batch as JSON or CSV in UTF-8.") from error
    except (SchemaError, RangeError) as error:
        reason = str(error).rstrip(".")
        raise InputFileError(f"{path} is no batch ({reason}): correct it.") from error
    return sorted(found, key=lambda bake: str(bake.job.light.environment))


def _read(text: str, path: Path, folder: Path) -> Iterator[BatchBake]:
    if path.suffix.lower() == ".csv":
        batches = [_Batch(**fields) for fields in rows_of(text)]
    else:
        plain = loads(text)
        if is_bake_list(plain):
            yield from bakes_of_list(plain, path.parent, folder)
            return
        batches = [decode(_Batch, plain)]
    for batch in batches:
        yield from _bakes(batch, path.parent, folder)


def _check(bakes: Sequence[BatchBake], path: Path) -> None:
    """Refuse a batch of nothing, and outputs that cannot be."""
    if not bakes:
        raise SchemaError("it has no environment and method")
    outputs: dict[str, BatchBake] = {}
    for bake in bakes:
        if not bake.job.output.lower().endswith(".exr"):
            raise SchemaError(f"output {bake.job.output} does not end in .exr")
        other = outputs.setdefault(os.path.abspath(bake.job.output), bake)
        if other is not bake:
            raise InputFileError(
                f"{path} makes {bake.job.output} of {other.title} and of {bake.title}: tell them apart in "
                f"the pattern of outputs, by {', '.join(f'{{{name}}}' for name in FIELDS)}."
            )


def _bakes(batch: _Batch, folder: Path, outputs: Path) -> Iterator[BatchBake]:
    environments = [each for text in batch.environments for each in _environments(text, folder)]
    materials = [each for text in batch.materials for each in _materials(text, folder)]
    for method in batch.methods:
        given = {"kind": method} if isinstance(method, str) else dict(method)
        kind = method_kind(str(given.pop("kind", "")))
        given = _with_files_beside(given, kind, folder)
        chooser = next(
            (each for each in declared_options(STORED[kind].settings) if each.option.materials), None
        )
        for size in batch.sizes or (None,):
            sized = given if size is None else given | {"size": size}
            for material in materials if chooser and materials else [""]:
                chosen = sized | ({chooser.name: _text(chooser, material)} if chooser and material else {})
                settings = decode(STORED[kind].settings, chosen, kind)
                for environment in environments:
                    names = {
                        "environment": _name(environment),
                        "material": _name(material),
                        "method": kind.replace("_", "-"),
                        "size": str(getattr(settings, "size", "")),
                    }
                    output = str(outputs / _filled(batch.output, names))
                    light = Light(environment=environment, clamp=batch.clamp)
                    job = BakeJob(settings, output, light, if_missing=True)
                    yield BatchBake(names["environment"], _title(material), job)


def _with_files_beside(given: dict[str, Any], kind: str, folder: Path) -> dict[str, Any]:
    """Settings whose files are looked for beside the batch."""
    files = [
        each.name
        for each in declared_options(STORED[kind].settings)
        if each.option.subtype == "FILE_PATH" and isinstance(given.get(each.name), str)
    ]
    texts = {
        name: _LIGHT.sub(lambda found: f"light={_environment(found[1].strip(), folder)}", value)
        for name, value in given.items()
        if isinstance(value, str)
    }
    return given | texts | {name: str(folder / given[name]) for name in files}


def _environments(text: str, folder: Path) -> Sequence[str]:
    """What a text names: pictures beside the batch, all that a pattern finds, or one of Blender's own."""
    if not text:
        raise SchemaError("an environment has no name")
    if is_pattern(text):
        # Map sets may lie beside environments, and are none
        return [str(path) for path in _files(text, folder) if not path.name.endswith(".rsibr.exr")]
    return [_environment(text, folder)]


def _environment(text: str, folder: Path) -> str:
    """What a text names: a file beside the batch, or itself, as one of Blender's own."""
    is_file = split_layer(folder / text)[0].is_file() or Path(split_layer(text)[0]).suffix
    return str(folder / text) if is_file else text


def _materials(text: str, folder: Path) -> Sequence[str]:
    """What a text names: materials in files beside the batch, all that a pattern finds, or itself."""
    blend = _BLEND.fullmatch(text)
    if blend is None:
        if is_pattern(text):
            return [str(path) for path in _files(text, folder)]
        if Path(text).suffix.lower() in MEASURED_FORMATS and not _PATH.search(text):
            return [str(folder / text)]
        return [_with_path(text, lambda path: folder / path)]
    files = _files(blend[1], folder) if is_pattern(blend[1]) else [folder / blend[1]]
    names = {file: _names(file, blend[2]) for file in files}
    if not any(names.values()):
        raise InputFileError(f"No material is called {text}: correct the batch.")
    return [f"{file}:{name}" for file in files for name in names[file]]


def _names(file: Path, pattern: str) -> list[str]:
    """The materials of a file of Blender that a pattern means; a name with its signs comes first."""
    if not is_pattern(pattern):
        return [pattern]
    from ...host.materials import names_in

    names = sorted(names_in(file))
    return [pattern] if pattern in names else [name for name in names if fnmatchcase(name, pattern)]


def is_pattern(text: str) -> bool:
    """Whether a text has signs that stand for others: all that fit are meant."""
    return any(sign in text for sign in "*?[")


def _files(pattern: str, folder: Path) -> list[Path]:
    """All files that a pattern means, at least one; a file that is called like the pattern is meant alone."""
    if (folder / pattern).is_file():
        return [folder / pattern]
    anchor = Path(pattern).anchor
    paths = sorted(Path(anchor or folder).glob(str(Path(pattern).relative_to(anchor))))
    if not paths:
        raise InputFileError(f"Nothing is called {pattern} in {folder}: correct the batch.")
    return paths


def _text(chooser: Declared, material: str) -> str:
    """A material as an option takes it."""
    taken = chooser.option.materials
    assert taken is not None
    measured = taken.own.removesuffix(":{}")
    if _BLEND.fullmatch(material):
        return f"{measured}{material}"
    if not taken.model:
        return material
    if Path(material).suffix.lower() in MEASURED_FORMATS and not _PATH.search(material):
        return measured_spec(material)
    return f"{measured}{material}" if material in PRESETS else _MODELS.get(material, material)


def _title(material: str) -> str:
    blend = _BLEND.fullmatch(material)
    if blend:
        return blend[2]
    if _PATH.search(material):
        return _with_path(material, lambda path: path.name)
    return Path(material).stem if Path(material).suffix.lower() in MEASURED_FORMATS else material


def _name(text: str) -> str:
    """A name of an environment or a material, as a part of a file's name."""
    blend = _BLEND.fullmatch(text)
    name = blend[2] if blend else _with_path(text, lambda path: path.name)
    if not blend and ("=" not in text) and Path(text).suffix:
        name = Path(text).stem
    return portable_name(name)


def _with_path(text: str, changed: Callable[[Path], Path | str]) -> str:
    """A model's text with another path in it, if it has one."""
    return _PATH.sub(lambda found: f"path={changed(Path(found[1]))}", text)


def _filled(pattern: str, names: dict[str, str]) -> str:
    def named(found: re.Match[str]) -> str:
        if found[1] not in names:
            raise SchemaError(f"output names {{{found[1]}}}, which is none of {', '.join(FIELDS)}")
        return names[found[1]]

    if re.search(r"[{}]", re.sub(r"\{[^{}]*\}", "", pattern)):
        raise SchemaError(f"output {pattern} has a brace without another")
    filled = re.sub(r"\{([^{}]*)\}", named, pattern)
    # Of a name that is empty, the sign that parts it from the one before goes too
    return re.sub(r"[-_]+(?=\.|/|$)", "", filled) if "" in names.values() else filled

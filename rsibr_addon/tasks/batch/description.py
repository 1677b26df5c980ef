"""What a batch is, and the bakes that it stands for."""

import csv
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from ...core.brdf.cycles_presets import PRESETS
from ...core.brdf.gallery import GALLERY
from ...core.errors import InputFileError, RangeError, SchemaError
from ...core.options import Declared, declared_options, value_from_text
from ...core.schema import decode, loads
from ...files.kinds.registry import STORED
from ...files.measured_files import MEASURED_FORMATS, measured_spec
from ...files.pictures import split_layer
from ...files.reading import opened
from ...job import BakeJob
from ...settings.light import Light

OUTPUT = "{environment}-{material}.rsibr.exr"
"""Pattern of outputs where a batch gives none."""

FIELDS = ("environment", "material", "method", "size")
"""What a pattern may name."""

_BLEND = re.compile(r"(.+?\.blend\d*):(.+)", re.IGNORECASE)
_MODELS = {name: text for models in GALLERY.values() for name, text in models.items()}


@dataclass(frozen=True)
class BatchBake:
    """One bake of a batch.

    Attributes
    ----------
    environment, material : str
        Names for people; the material's is empty where light alone is baked.
    job : BakeJob
    """

    environment: str
    material: str
    job: BakeJob[Any]

    @property
    def title(self) -> str:
        """What is baked, in words."""
        return f"{self.material or self.job.settings.LABEL} in {self.environment}"


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


def read_batch(path: Path) -> list[BatchBake]:
    """The bakes of a batch, those in the same environment behind each other.

    Parameters
    ----------
    path : Path
        BATCH.json, or BATCH.csv. What it names is looked for beside it.

    Raises
    ------
    InputFileError
        The file is missing or no batch, a pattern finds no file, or two bakes would have one output.
    """
    with opened(path) as stream:
        data = stream.read()
    try:
        text = data.decode("utf-8-sig")
        batches = _rows(text) if path.suffix.lower() == ".csv" else [decode(_Batch, loads(text))]
        found = [bake for batch in batches for bake in _bakes(batch, path.parent)]
    except UnicodeDecodeError as error:
        raise InputFileError(f"{path} is no text: give a batch as JSON or CSV in UTF-8.") from error
    except (SchemaError, RangeError) as error:
        reason = str(error).rstrip(".")
        raise InputFileError(f"{path} is no batch ({reason}): correct it.") from error
    outputs: dict[str, BatchBake] = {}
    for bake in found:
        other = outputs.setdefault(bake.job.output, bake)
        if other is not bake:
            raise InputFileError(
                f"{path} makes {bake.job.output} of {other.title} and of {bake.title}: tell them apart in "
                f"the pattern of outputs, by {', '.join(f'{{{name}}}' for name in FIELDS)}."
            )
    return sorted(found, key=lambda bake: str(bake.job.light.environment))


def _rows(text: str) -> Iterator[_Batch]:
    """A batch for each row of a table."""
    table = csv.DictReader(io.StringIO(text))
    for number, row in enumerate(table, 2):
        cells = {name: cell for name, cell in row.items() if name and cell}
        try:
            environment, method = cells.pop("environment"), cells.pop("method")
        except KeyError as error:
            raise SchemaError(f"line {number} has no {error.args[0]}") from error
        material, clamp = cells.pop("material", None), cells.pop("clamp", None)
        output = cells.pop("output", OUTPUT)
        settings = {"kind": method} | _values(_kind(method), cells, number)
        materials = () if material is None else (material,)
        limit = None if clamp is None else _number(clamp, number)
        yield _Batch((environment,), (settings,), materials, (), output, limit)


def _number(text: str, line: int) -> float:
    try:
        return float(text)
    except ValueError:
        raise SchemaError(f"clamp of line {line} is not a number") from None


def _values(kind: str, cells: dict[str, str], line: int) -> dict[str, Any]:
    """Settings as JSON has them, of the cells of a row."""
    known = {each.name: each for each in declared_options(STORED[kind].settings)}
    values: dict[str, Any] = {}
    for name, cell in cells.items():
        if name not in known:
            raise SchemaError(f"column {name} of line {line} is none of {', '.join(known)}")
        try:
            is_flag = known[name].wanted is bool
            value = cell.lower() == "true" if is_flag else value_from_text(known[name], cell)
        except ValueError as error:
            raise SchemaError(f"{name} of line {line}: {error}") from error
        values[name] = list(value) if isinstance(value, tuple) else value
    return values


def _kind(name: str) -> str:
    kind = name.replace("-", "_")
    if kind not in STORED:
        raise SchemaError(f"there is no method {name}: choose one of {', '.join(STORED)}")
    return kind


def _bakes(batch: _Batch, folder: Path) -> Iterator[BatchBake]:
    environments = [each for text in batch.environments for each in _found(text, folder)]
    materials = [each for text in batch.materials for each in _found(text, folder)]
    for method in batch.methods:
        given = {"kind": method} if isinstance(method, str) else dict(method)
        kind = _kind(str(given.pop("kind", "")))
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
                    output = str(folder / _filled(batch.output, names))
                    light = Light(environment=environment, clamp=batch.clamp)
                    job = BakeJob(settings, output, light, if_missing=True)
                    yield BatchBake(names["environment"], _title(material), job)


def _found(text: str, folder: Path) -> Sequence[str]:
    """What a text of a batch names: files beside it, all that a pattern finds, or itself."""
    blend = _BLEND.fullmatch(text)
    file, rest = (blend[1], f":{blend[2]}") if blend else (text, "")
    if any(sign in file for sign in "*?["):
        try:
            paths = sorted(folder.glob(file))
        except (NotImplementedError, ValueError):  # an absolute one
            paths = sorted(Path(Path(file).anchor).glob(str(Path(file).relative_to(Path(file).anchor))))
        if not paths:
            raise InputFileError(f"Nothing is called {text} in {folder}: correct the batch.")
        return [f"{path}{rest}" for path in paths]
    is_file = (
        blend or split_layer(folder / file)[0].is_file() or Path(file).suffix.lower() in MEASURED_FORMATS
    )
    return [f"{folder / file}{rest}" if is_file else text]


def _text(chooser: Declared, material: str) -> str:
    """A material as an option takes it."""
    taken = chooser.option.materials
    assert taken is not None
    measured = taken.own.removesuffix(":{}")
    if _BLEND.fullmatch(material):
        return f"{measured}{material}"
    if not taken.model:
        return material
    if Path(material).suffix.lower() in MEASURED_FORMATS and ":path=" not in material:
        return measured_spec(material)
    return f"{measured}{material}" if material in PRESETS else _MODELS.get(material, material)


def _title(material: str) -> str:
    blend = _BLEND.fullmatch(material)
    if blend:
        return blend[2]
    return Path(material).stem if Path(material).suffix.lower() in MEASURED_FORMATS else material


def _name(text: str) -> str:
    """A name of an environment or a material, as a part of a file's name."""
    blend = _BLEND.fullmatch(text)
    name = blend[2] if blend else text
    if not blend and ("=" not in text) and Path(text).suffix:
        name = Path(text).stem
    return re.sub(r"[^\w.]+", "-", name).strip("-")


def _filled(pattern: str, names: dict[str, str]) -> str:
    def named(found: re.Match[str]) -> str:
        if found[1] not in names:
            raise SchemaError(f"output names {{{found[1]}}}, which is none of {', '.join(FIELDS)}")
        return names[found[1]]

    return re.sub(r"\{(\w*)\}", named, pattern)

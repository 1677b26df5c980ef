"""A batch as a job bundle of Open Job Description (OpenJD), which Deadline Cloud and `openjd run` take."""

import json
from collections.abc import Sequence
from pathlib import Path
from string import Template

from ...core.errors import RangeError
from ...core.progress import Steps
from ...files.atomic import written_aside
from ...files.outputs import made_folders
from ..batch.bakes import BatchBake, parts_of
from .folder import INPUTS, MAPS, batch_name, write_inputs

TEMPLATE = Path(__file__).with_suffix(".yaml")

MOST_PARTS = 1024
"""Most values of a task's parameter, as OpenJD's specification of 2023-09 limits it."""

LONGEST_NAME = 128
"""Most letters of a job's name."""


def write_bundle(folder: Path, title: str, bakes: Sequence[BatchBake], program: Sequence[str]) -> Steps[Path]:
    """Write a bundle: a template, the parameters' values, and a folder with all that the bakes need.

    Parameters
    ----------
    folder : Path
        Made if it is missing; the template of a bundle in it is replaced.
    title : str
    bakes : sequence of BatchBake
        From `folder.bakes_to_send`.
    program : sequence of str
        What starts `rsibr` on a machine of the farm.

    Returns
    -------
    Path
        The template.

    Raises
    ------
    RangeError
        There are more parts than OpenJD lets a step have.
    InputFileError, SceneError, OutputFileError
        See `folder.write_inputs`.

    Notes
    -----
    A step for the bakes has a task for each environment and method: bakes of one environment share its
    reading, and the start of Python and Blender. YAML takes each value as JSON.
    """
    name = batch_name(title)[:LONGEST_NAME]
    with made_folders(folder / INPUTS, folder / MAPS):
        placed = yield from write_inputs(folder / INPUTS, name, bakes)
    parts = list(parts_of(placed))
    if len(parts) > MOST_PARTS:
        raise RangeError(
            f"The batch has {len(parts)} pairs of environment and method, and a job of OpenJD at most "
            f"{MOST_PARTS}: split it."
        )
    batch = [*program[1:], "batch", f"{{{{Param.Inputs}}}}/{name}.json", "--output", "{{Param.Maps}}"]
    values = {
        "name": name,
        "inputs": INPUTS,
        "maps": MAPS,
        "parts": parts,
        "program": program[0],
        "bake": [*batch, "--progress", "openjd", "--part", "{{Task.Param.Part}}"],
        "page": [*batch, "--progress", "openjd", "--page"],
    }
    quoted = {key: json.dumps(value, ensure_ascii=False) for key, value in values.items()}
    template = folder / "template.yaml"
    _write(template, Template(TEMPLATE.read_text(encoding="utf-8")).substitute(quoted))
    given = [{"name": "Inputs", "value": INPUTS}, {"name": "Maps", "value": MAPS}]
    _write(folder / "parameter_values.json", json.dumps({"parameterValues": given}, indent=1) + "\n")
    return template


def _write(path: Path, text: str) -> None:
    with written_aside(path, force=True) as aside:
        aside.write_text(text, encoding="utf-8")

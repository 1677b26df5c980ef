"""Readers of JSON and of map sets, fed with damage: `python -m rsibr.tests.faults.fuzz --cases 1000`.

Each case ends in a result or in an error of ours, of one sentence. All else is told, with what makes it
again: the numbers of the seed and of the case.
"""

import argparse
import contextlib
import io
import json
import random
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import bpy  # noqa: F401  (tasks need it)
from rsibr.rsibr_addon.command_line import info, job
from rsibr.rsibr_addon.command_line.console import Console
from rsibr.rsibr_addon.core.errors import DeviceError, RsibrError
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.exr import read_parts, write_parts
from rsibr.rsibr_addon.files.exr_part import Part
from rsibr.rsibr_addon.files.fits import read_fit
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header, write_map_set
from rsibr.rsibr_addon.files.map_set_mark import ATTRIBUTE
from rsibr.rsibr_addon.files.work_folder import held_work_folder, kept_parts
from rsibr.rsibr_addon.tasks.compare.measured_error import measured_facts
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.export.engines.settings import CubeSettings
from rsibr.rsibr_addon.tasks.export.export import export
from rsibr.rsibr_addon.tasks.methods.kinds import open_map_set
from rsibr.rsibr_addon.tasks.queue.background import Bake
from rsibr.rsibr_addon.tasks.reflectance.brdfs import check_told_brdf
from rsibr.rsibr_addon.tasks.reflectance.fit_plots import lobe_picture
from rsibr.rsibr_addon.tasks.report import report as map_set_report
from rsibr.rsibr_addon.tasks.report.facts import map_set_content, map_set_facts, map_set_fit
from rsibr.rsibr_addon.tasks.report.pictures import map_set_pictures
from rsibr.tests.faults.fuzzing import Reader, run_cases
from rsibr.tests.faults.mutations import damaged_bytes, damaged_json
from rsibr.tests.faults.small_json_files import json_files
from rsibr.tests.faults.small_map_sets import map_sets

SECONDS = 10
"""That no case takes."""

MEGABYTES = 200
"""That no case takes beyond those before."""


def _info(path: Path) -> None:
    told = info.run(argparse.Namespace(file=str(path)), Console("none", io.StringIO()))
    json.dumps(told).encode()


def _facts(path: Path) -> None:
    map_set_facts(path)
    map_set_content(path)
    fit = map_set_fit(path)
    if fit is not None:
        lobe_picture(fit, 0.5)


def _page(path: Path) -> None:
    drain(map_set_report.map_set_report(path, path.with_suffix(".html"), force=True))


def _compare(path: Path) -> None:
    opened = open_map_set(path)
    if opened.kind == "lobe_stack":
        check_told_brdf(opened.material["brdf"])


def _export(path: Path) -> None:
    drain(export(path, path.with_suffix(".ktx2"), force=True))


def _export_for_engine(path: Path) -> None:
    drain(export_for_engine(path, path.with_suffix(".ktx"), "filament", CubeSettings(size=32), force=True))


def _work(path: Path) -> None:
    folder = path.with_suffix("")
    folder.mkdir(exist_ok=True)
    (folder / "lock").touch()
    (folder / "job.json").write_bytes(path.read_bytes())
    with held_work_folder(folder), kept_parts(folder, {"a": 1}):
        pass


def _background(path: Path) -> None:
    text = path.read_text(encoding="utf-8", errors="replace")
    line = text.replace("\n", " ")
    bake = Bake("", path, ())
    bake._read_progress(io.StringIO(f'{line}\n{{"progress": {line}}}\n'))
    bake._read_result(io.StringIO(line))
    bake._parsed_result()
    assert bake.fraction >= 0.0


def _comparison(path: Path) -> None:
    folder = path.with_name("a-compared")
    folder.mkdir(exist_ok=True)
    (folder / "comparison.json").write_bytes(path.read_bytes())
    measured_facts(path.with_name("a.rsibr.exr"))


def _job(path: Path) -> None:
    done = patch("rsibr.rsibr_addon.command_line.job.run_job", lambda job, console: {})
    with done, patch("rsibr.rsibr_addon.command_line.bake.run_job", lambda job, console: {}):
        job.run(argparse.Namespace(job=path), Console("none", io.StringIO()))


OF_MAP_SETS: list[Reader] = [
    *(_info, _facts, _page, _compare, _export, _export_for_engine),
    *(read_map_set, map_set_pictures, read_map_set_header),
]
OF_JSON: dict[str, list[Reader]] = {
    "fit.json": [read_fit],
    "job.json": [_job, _work, _background],
    "views.json": [_comparison, _work],
    "stack.json": [_comparison],
}


def cases(folder: Path, rng: random.Random) -> Iterator[tuple[Path, Reader]]:
    """Damaged files without end, and what is to read them."""
    path = folder / "a.rsibr.exr"
    written = []
    for map_set in map_sets():
        write_map_set(path, map_set, force=True)
        cover, *parts = read_parts(path)
        written.append((cover, parts, json.loads(cover.attributes[ATTRIBUTE]), path.read_bytes()))
    whole = path.read_bytes()
    texts = {name: json.loads(text) for name, text in json_files(folder).items()}
    while True:
        if rng.random() < 0.3:
            name = rng.choice(list(texts))
            path.write_bytes(whole)
            damaged = folder / f"damaged-{name}"
            damaged.write_bytes(damaged_json(texts[name], rng).encode(errors="surrogateescape"))
            yield damaged, rng.choice(OF_JSON[name])
            continue
        cover, parts, header, data = rng.choice(written)
        if rng.random() < 0.15:
            path.write_bytes(damaged_bytes(data, rng))
        else:
            attributes = {ATTRIBUTE: damaged_json(header, rng).encode("ascii", "replace").decode()}
            kept = [Part(part.name, part.channels, {}) for part in parts]
            write_parts(path, [Part(cover.name, cover.channels, attributes), *kept])
        yield path, rng.choice(OF_MAP_SETS)


@contextlib.contextmanager
def _without_device() -> Iterator[None]:
    """Within, nothing can draw: pictures of meshes would take most of the time."""

    def refuse(*_: Any) -> None:
        raise DeviceError("There is no driver: this is a test.")

    with patch.object(map_set_report, "_drawn_meshes", refuse):
        yield


if __name__ == "__main__":
    with _without_device():
        sys.exit(run_cases(cases, SECONDS, MEGABYTES, (RsibrError, OSError)))

"""Compare pictures drawn from a map set with a reference: figures, and a report."""

import json
from pathlib import Path

from ...core.errors import MapSetError
from ...core.progress import Progress, Steps
from ...device.context import ensure_context
from ...files.apart import check_apart
from ...files.folders import check_folder_target, folder_written_aside
from ...files.kinds.registry import STORED
from ...files.map_set_header import content_hash
from ...settings.comparison import ComparisonOptions
from ..methods.kinds import KINDS, open_map_set
from ..report.facts import map_set_header
from .comparison import RESULT, Comparison, cameras_of
from .pictures import save_sheets
from .report import comparison_report
from .truth import Truth


def truth_of(map_set: Path) -> Truth:
    """The reference that a map set can be compared with.

    Raises
    ------
    MapSetError
        The file is no map set, or of a kind that nothing is compared with.
    """
    truth = KINDS[map_set_header(map_set)["kind"]].truth
    if truth is None:
        kinds = " or ".join(kind.replace("_", " ") for kind, row in KINDS.items() if row.truth)
        raise MapSetError(f"{map_set.name} is of a kind without a truth to compare with: bake {kinds}.")
    return truth


def compare(
    map_set: Path, settings: ComparisonOptions, output: Path, force: bool = False
) -> Steps[Comparison]:
    """Make references of random views, draw the same views from a map set, and measure the difference.

    Parameters
    ----------
    map_set : Path
        With the environment that it was made in.
    settings : ComparisonOptions
        Settings of its kind: see `truth_of`.
    output : Path
        A folder to be made: comparison.json (`Comparison.to_json`), index.html, which shows all of
        it by itself, and its pictures as images/*.png.
    force : bool
        Whether an earlier comparison in `output` is replaced.

    Raises
    ------
    MapSetError
        The map set does not hold its environment, or is of another kind than the settings.
    InputFileError
        The material is gone, is not what it was, or is in another file that `settings` does not name; or the
        mesh cannot be used.
    OutputFileError, RangeError, RenderError, DeviceError

    Notes
    -----
    Errors are those of radiance where both pictures cover a pixel, weighted by the lesser coverage, so that
    how each samples a silhouette does not count.
    """
    check_folder_target(output, RESULT, force)
    check_apart(output, [map_set])
    total = settings.views + 2
    yield Progress(0, total, f"reading {map_set.name}")
    header, truth = map_set_header(map_set), truth_of(map_set)
    if not isinstance(settings, STORED[header["kind"]].comparison or ()):
        raise MapSetError(f"{map_set} holds {header['kind']}, which are not compared so: give another.")
    opened = open_map_set(map_set)
    if opened.environment is None:
        raise MapSetError(
            f"{map_set} does not hold the environment that it was made in, in which it would be compared: "
            f"make it again."
        )
    ensure_context()
    seen = yield from truth.draw(map_set, opened.content, opened.environment, opened.material, settings)
    yield Progress(total - 1, total, f"writing {output.name}")
    comparison = Comparison(
        map_set=map_set.name,
        content=content_hash(header),
        environment=opened.environment.name,
        material=seen.material,
        map_size=seen.map_size,
        settings=seen.settings,
        view_dirs=tuple(camera.view_dir for camera in cameras_of(settings)),
        reference_noise=seen.noise,
        errors=seen.errors,
    )
    with folder_written_aside(output, RESULT, force) as folder:
        sheets = save_sheets(folder / "images", seen.references, seen.drawn)
        text = comparison_report(comparison, truth.telling(seen.settings), sheets)
        (folder / "index.html").write_text(text, encoding="utf-8", errors="replace")
        (folder / RESULT).write_text(json.dumps(comparison.to_json(), indent=1), encoding="utf-8")
    return comparison

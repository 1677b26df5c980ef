"""A comparison as one HTML file that needs nothing beside it."""

import base64
import math
from html import escape
from pathlib import Path
from string import Template

from .comparison import Comparison, Way, WayError
from .pictures import BRIGHTER, COLUMNS, DARKER, FULL_DIFFERENCE, Sheets
from .truth import Telling

TEMPLATE = Path(__file__).with_suffix(".html")


def comparison_report(comparison: Comparison, telling: Telling, sheets: Sheets) -> str:
    """Show numbers and pictures of a comparison.

    Parameters
    ----------
    comparison : Comparison
    telling : Telling
        Of its references.
    sheets : Sheets
        Its pictures, which the report takes in.

    Returns
    -------
    str
        HTML for light and dark screens, without scripts and links.
    """
    shown = comparison.errors[-1].way
    count = len(comparison.view_dirs)
    return Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        material=escape(comparison.material),
        environment=escape(comparison.environment),
        map_set=escape(comparison.map_set),
        mesh=escape(_mesh(comparison)),
        reference_name=telling.name,
        made=telling.made,
        notes=telling.notes(comparison),
        view_count=count,
        full_difference=f"{100.0 * FULL_DIFFERENCE:g}&thinsp;%",
        brighter=_css_colour(BRIGHTER),
        darker=_css_colour(DARKER),
        sheet_size=f"{100 * min(count, COLUMNS)}% {100 * math.ceil(count / COLUMNS)}%",
        reference=_embedded(sheets.reference),
        rules="\n".join(_rules(error.way, sheets) for error in comparison.errors),
        ways="\n".join(_row(error, comparison, error.way == shown) for error in comparison.errors),
        figures="\n".join(_figure(comparison, telling, number) for number in range(count)),
        settings="\n".join(
            f"<dt>{name}</dt><dd>{value}</dd>" for name, value in _settings(comparison, telling)
        ),
    )


def _rules(way: Way, sheets: Sheets) -> str:
    """The style sheet's rules that show a way's pictures and numbers when its button is pressed."""
    chosen = f"body:has(#way-{way.slug}:checked)"
    return f"""{chosen} .drawing {{ background-image: {_embedded(sheets.drawing[way])}; }}
{chosen} .difference {{ background-image: {_embedded(sheets.difference[way])}; }}
{chosen} .error-{way.slug} {{ display: inline; }}"""


def _row(error: WayError, comparison: Comparison, checked: bool) -> str:
    way = error.way
    # Errors below the noise may all be 0.
    largest = max(each.pooled for each in comparison.errors) or 1.0
    button = f'<input type="radio" name="way" id="way-{way.slug}"{" checked" if checked else ""}>'
    numbers = "".join(
        f'<td class="number">{_percent(value)}</td>' for value in (error.pooled, error.median, error.worst)
    )
    bar = f'<td class="bar"><span style="width: {100.0 * error.pooled / largest:.1f}%"></span></td>'
    return f"<tr><td><label>{button}{way.name}</label></td>{numbers}{bar}</tr>"


def _figure(comparison: Comparison, telling: Telling, number: int) -> str:
    count = len(comparison.view_dirs)
    columns, rows = min(count, COLUMNS), math.ceil(count / COLUMNS)
    row, column = divmod(number, COLUMNS)
    # Percentages of a background's position run from its first tile to its last.
    at = f"{100.0 * column / max(columns - 1, 1):.4f}% {100.0 * row / max(rows - 1, 1):.4f}%"
    names = {"reference": telling.name, "drawing": "RSIBR", "difference": "difference"}
    tiles = "".join(
        f'<div class="tile {kind}" style="--at: {at}" role="img" aria-label="{name}, view {number + 1}">'
        "</div>"
        for kind, name in names.items()
    )
    labels = "".join(f"<span>{name}</span>" for name in names.values())
    errors = "".join(
        f'<b class="error-{error.way.slug}">{_percent(error.per_view[number])}</b>'
        for error in comparison.errors
    )
    x, y, z = comparison.view_dirs[number]
    caption = f"{errors}view {number + 1}, from ({x:.2f}, {y:.2f}, {z:.2f})"
    return f"<figure>{tiles}{labels}<figcaption>{caption}</figcaption></figure>"


def _settings(comparison: Comparison, telling: Telling) -> list[tuple[str, str]]:
    """Names and values, in words."""
    settings = comparison.settings
    angle = settings.perspective
    return [
        ("map set", escape(comparison.map_set)),
        ("material", escape(comparison.material)),
        ("environment", escape(comparison.environment)),
        ("maps", f"{comparison.map_size}&times;{comparison.map_size}"),
        ("mesh", escape(_mesh(comparison))),
        ("camera", "orthographic" if angle is None else f"perspective, {angle:g}&deg;"),
        ("pictures", f"{settings.size}&times;{settings.size}"),
        (telling.name, telling.quality),
        ("seed", str(settings.seed)),
    ]


def _mesh(comparison: Comparison) -> str:
    known = {"sphere": "a sphere", "monkey": "Suzanne"}
    mesh = comparison.settings.mesh
    return known.get(mesh, Path(mesh).name)


def _percent(ratio: float) -> str:
    percent = 100.0 * ratio
    return f"{percent:.{1 if percent >= 10.0 else 2}f}&thinsp;%"


def _css_colour(linear: tuple[float, float, float]) -> str:
    return f"color(srgb-linear {' '.join(map(str, linear))})"


def _embedded(picture: Path) -> str:
    return f"url(data:image/png;base64,{base64.b64encode(picture.read_bytes()).decode('ascii')})"

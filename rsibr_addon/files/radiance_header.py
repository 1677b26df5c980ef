"""The header of a Radiance HDR picture: its size, and the meaning of its values."""

import re
from dataclasses import dataclass

import numpy as np

from ..core.conventions import Array
from .chromaticities import REC_709, XYZ, rec709_from

AXES = re.compile(rb"([-+])([XY]) +(\d{1,9}) +([-+])([XY]) +(\d{1,9})\s*")
FIELD = re.compile(r"([A-Za-z][\w-]*)\s*=(.*)")
"""A statement; other lines are a program's command, its history (indented) or a comment."""

LONGEST = 1 << 16
"""Longest header in bytes; hundreds of editing steps leave some thousand."""

COUNTS = {"EXPOSURE": 1, "COLORCORR": 3, "PRIMARIES": 8, "GAMMA": 1, "PIXASPECT": 1}
"""Field about the meaning of the values -> its count of numbers."""

IGNORED = {
    "GAMMA": "its values are taken as linear, as programs do that write so",
    "PIXASPECT": "its pixels are taken as square",
}
"""Field of `COUNTS` that is not undone unless it is 1, or 0 for none -> the remark about it."""

HARMLESS = re.compile(
    "FORMAT|SOFTWARE|VIEW|CAPDATE|GMT|OWNER|COPYRIGHT|AUTHOR|DATE|TIME|COMMENT|"
    "COMMENTS|DESCRIPTION|NAME|TITLE|CREATOR|PROGRAM|VERSION|CAMERA|LENS|NCOMP|NROWS|NCOLS"
)
"""Fields that do not change the pixels' meaning."""

SHOWN = 80
"""Letters of a header line that messages show."""


@dataclass(frozen=True)
class RadianceHeader:
    """The statements of the header.

    Attributes
    ----------
    axes : str
        Direction from line to line and along a line, such as "-Y+X".
    line_count, line_length : int
    scale : ndarray, shape (3,)
        Factors of the values: exposures and colour corrections.
    matrix : ndarray, shape (3, 3)
        Linear Rec. 709 from the stored values, for column vectors; the scale is undone too.
    colours : str
        Meaning of the values, and its source.
    comments : str
        What the file says of itself in words.
    remarks : tuple of str
        Parts of it that are not used: predicates, whose subject is the file.
    """

    axes: str
    line_count: int
    line_length: int
    scale: Array
    matrix: Array
    colours: str
    comments: str
    remarks: tuple[str, ...]

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture."""
        across, along = self.line_count, self.line_length
        return (along, across) if self.axes[1] == "Y" else (across, along)


def parse_header(data: bytes) -> tuple[RadianceHeader, int]:
    """Read a header.

    Parameters
    ----------
    data : bytes
        Bytes of a file from the first; `LONGEST` are enough.

    Returns
    -------
    RadianceHeader
    int
        Start of the pixels.

    Raises
    ------
    ValueError
        It states no size, or another format of pixels.
    """
    lines, axes, start = _split(data)
    fields = [field for line in lines if (field := FIELD.fullmatch(line))]
    primaries, colours = _stored_colours([field[2] for field in fields if field[1].upper() == "FORMAT"])
    scale, remarks = np.ones(3), []
    for field in fields:
        name, value, line = field[1].upper(), field[2].strip(), f"the header line {field[0][:SHOWN]!r}"
        try:
            if name in COUNTS:
                numbers, rest = _numbers(value, COUNTS[name])
                if rest:
                    remarks.append(f"has {line}: its end, {rest[:SHOWN]!r}, is left out.")
                if name in ("EXPOSURE", "COLORCORR"):
                    scale = scale * _factors(numbers)
                elif name == "PRIMARIES" and np.any(numbers) and primaries is REC_709:
                    rec709_from(numbers)
                    primaries, colours = tuple(numbers), f"of the primaries {value}, as PRIMARIES says"
                elif name in IGNORED and numbers[0] not in (0.0, 1.0):
                    remarks.append(f"has {line}, but {IGNORED[name]}.")
            elif not HARMLESS.fullmatch(name):
                remarks.append(f"has {line}, which is not used.")
        except ValueError:
            remarks.append(f"has {line}, which cannot be used: it is left out.")
    matrix = rec709_from(primaries) / scale
    order = b"".join(axes.group(1, 2, 4, 5)).decode()
    comments = " ".join(field[2].strip() for field in fields if field[1].upper() == "COMMENTS")
    header = RadianceHeader(
        order, int(axes[3]), int(axes[6]), scale, matrix, colours, comments, tuple(remarks)
    )
    return header, start


def _split(data: bytes) -> tuple[list[str], re.Match[bytes], int]:
    """The lines before the one that states the size, that line, and the start of the next.

    An empty line stands before the size, which some writers leave out.
    """
    lines: list[str] = []
    start = 0
    while (end := data.find(b"\n", start, LONGEST)) >= 0:
        line, start = data[start:end].rstrip(b"\r"), end + 1
        axes = AXES.fullmatch(line)
        if axes and {axes[2], axes[5]} == {b"X", b"Y"} and int(axes[3]) and int(axes[6]):
            return lines, axes, start
        lines.append(line.decode("latin-1"))
    raise ValueError("it states no size")


def _stored_colours(formats: list[str]) -> tuple[tuple[float, ...], str]:
    """Primaries of the stored values, as numbers and in words."""
    primaries, colours = REC_709, "Rec. 709, as nothing else is stated"
    for value in map(str.strip, formats):
        if "xyze" in value.lower():
            primaries, colours = XYZ, "CIE XYZ, as FORMAT says"
        elif value and "rgbe" not in value.lower():
            raise ValueError(f"its format is {value[:SHOWN]!r}")
    return primaries, colours


def _numbers(text: str, count: int) -> tuple[Array, str]:
    """The first numbers of a text, with decimal points or commas, or separated by commas; and the rest."""
    words = text.split()
    if len(words) < count:
        words = re.split(r"[\s,;]+", text)
    numbers = np.array([float(word.strip(",;").replace(",", ".")) for word in words[:count]])
    if numbers.shape != (count,):
        raise ValueError(f"{text!r} are not {count} numbers")
    return numbers, " ".join(words[count:])


def _factors(factors: Array) -> Array:
    """Factors of the values; zeros, as FreeImage writes, mean none."""
    if not np.any(factors):
        return np.ones_like(factors)
    if not np.all(np.isfinite(factors) & (factors > 0.0)):
        raise ValueError("factors must be positive")
    return factors

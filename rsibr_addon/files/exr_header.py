"""Statements of an OpenEXR header on its pixels beyond their names: colours, windows, orientation."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.conventions import Array, ArrayLike
from ..core.counted import in_short
from .chromaticities import REC_709, luminance_weights, rec709_from
from .exr import CUBE, primaries_named
from .exr_part import window_size

ACES = (0.7347, 0.2653, 0.0, 1.0, 0.0001, -0.077, 0.32168, 0.33767)
"""Chromaticities of every picture in an ACES container, stated or not."""

LINEAR_REC_709 = re.compile(
    r"(scene_?)?linear( rec\.?709.*)?|lin_(srgb|rec709)(_scene)?|unknown|", re.IGNORECASE
)
"""Names of colour spaces that need no conversion."""

COLOUR_SPACE = re.compile(r"(oiio:)?colou?r_?space", re.IGNORECASE)

HARMLESS = re.compile(
    "name|type|view|multiView|channels|compression|dataWindow|displayWindow|lineOrder|tiles|version|chunkCount|"
    "chromaticities|colorInteropID|acesImageContainerFlag|adoptedNeutral|pixelAspectRatio|envmap|Orientation|"
    "screenWindow(Center|Width)|preview|originalDataWindow|deepImageState|idManifest|maxSamplesPerPixel|"
    "whiteLuminance|renderingTransform|lookModTransform|xDensity|ResolutionUnit|[XY]Resolution|wrapmodes|"
    "owner|comments|Comment|capDate|[dD]ate(Time)?|utcOffset|longitude|latitude|altitude|focus|expTime|aperture|"
    "isoSpeed|keyCode|timeCode|framesPerSecond|imageCounter|reelName|shutterAngle|tStop|ascFramingDecisionList|"
    "(nominal|effective|pinhole)FocalLength|entrancePupilOffset|(camera|lens|sensor)[A-Z].*|worldTo(Camera|NDC)|"
    "(dwa|zip|zstd|ht)CompressionLevel|[sS]oftware|[cC]opyright|[aA]rtist|[cC]reator|ImageDescription|DocumentName|"
    "HostComputer|Make|Model|ExposureTime|FNumber|PhotoshopLayerInfo|BlenderMultiChannel|Camera|File|Frame|Memory|"
    "Marker|Note|Hostname|RenderTime|Scene|Sequence|Strip|Time|TimeCode|"
    "((Exif|GPS|IPTC|XMP|ICCProfile|oiio|cycles|cryptomatte|nuke|arnold|mantra|husk|rs|vray|renderman|prman|exr|"
    r"textureformat|MaterialX|openexr)[.:/].*)"
)
"""Attributes that are read, or that do not change the pixels' meaning."""


@dataclass(frozen=True)
class Meaning:
    """The meaning of a part's pixels.

    Attributes
    ----------
    primaries : array_like, shape (8,)
        Primaries of its colours, as `rec709_from` takes them.
    colours : str
        The colours and their source, in words.
    remarks : tuple of str
        Parts of the header that are not used: predicates, whose subject is the file.
    """

    primaries: ArrayLike
    colours: str
    remarks: tuple[str, ...]

    @property
    def matrix(self) -> Array:
        """Linear Rec. 709 from the stored colours, shape (3, 3)."""
        return rec709_from(self.primaries)

    @property
    def luminance_weights(self) -> Array:
        """Luminance of the stored colours' primaries, shape (3,)."""
        return luminance_weights(self.primaries)


def meaning(header: dict[str, Any]) -> Meaning:
    """Read the meaning of a part's pixels from its header.

    Parameters
    ----------
    header : dict
        One of `exr.OpenExr.headers`.
    """
    primaries, colours, remarks = _primaries(header)
    return Meaning(primaries, colours, (*remarks, *_ignored(header, primaries), *_unknown(header)))


def _primaries(header: dict[str, Any]) -> tuple[ArrayLike, str, list[str]]:
    """Primaries: as stated, else of the named colour space, else Rec. 709; and remarks."""
    named, remarks = _named_space(header)
    stated = header.get("chromaticities")
    if stated is not None:
        try:
            numbers = np.asarray(stated, dtype=np.float64).reshape(8)
            # Zeros mean that none are stated
            if np.any(numbers):
                rec709_from(numbers)
                listed = " ".join(f"{number:.4g}" for number in numbers)
                if named is not None and not np.allclose(named[0], numbers, atol=1e-3):
                    remarks.append(
                        f"states chromaticities that are not those of {named[1]}: these are taken."
                    )
                return numbers, f"of the primaries {listed}, as its chromaticities say", remarks
        except (TypeError, ValueError):  # TypeError: they are no numbers at all
            remarks.append("states chromaticities that span no colours: they are left out.")
    if named is not None:
        return named[0], f"{named[1]}, as it says", remarks
    return REC_709, "Rec. 709, as nothing else is stated", remarks


def _named_space(header: dict[str, Any]) -> tuple[tuple[ArrayLike, str] | None, list[str]]:
    """Primaries of the colour space that a header names, and its name; and remarks."""
    space = header.get("colorInteropID")
    if isinstance(space, str):
        primaries = primaries_named(space)
        if primaries is not None:
            return (primaries, space), []
        if not LINEAR_REC_709.fullmatch(space):
            return None, [
                f"states the colour space {space!r}, which is not linear light: it is taken as such."
            ]
    if header.get("acesImageContainerFlag") == 1:
        return (ACES, "the ACES container's"), []
    return None, []


def _ignored(header: dict[str, Any], primaries: ArrayLike) -> Iterator[str]:
    """Statements that should make a difference but are not used."""
    aspect = header.get("pixelAspectRatio", 1.0)
    if np.isfinite(aspect) and aspect > 0.0 and abs(aspect - 1.0) > 1e-3:
        yield f"states a pixelAspectRatio of {aspect:.4g}, but its pixels are taken as square."
    if header.get("Orientation", 1) not in (0, 1):
        yield f"states an Orientation of {header['Orientation']}, but is taken as it is stored."
    width, height = window_size(header["displayWindow"])
    if header.get("envmap") == CUBE and height != 6 * width:
        yield "states that it is a cube map, but does not have six faces one below the other."
    neutral = header.get("adoptedNeutral")
    if (
        neutral is not None
        and np.any(neutral)
        and not np.allclose(neutral, np.ravel(primaries)[6:], atol=1e-3)
    ):
        listed = " ".join(f"{number:.4g}" for number in np.ravel(neutral))
        yield f"states an adoptedNeutral of {listed}, which is not its white: the white is taken."
    for name, value in header.items():
        if COLOUR_SPACE.fullmatch(name) and not LINEAR_REC_709.fullmatch(str(value)):
            yield f"states the {name} {str(value)[:60]!r}, which is not used."


def _unknown(header: dict[str, Any]) -> Iterator[str]:
    """Unknown attributes."""
    unknown = [name for name in header if not HARMLESS.fullmatch(name) and not COLOUR_SPACE.fullmatch(name)]
    if unknown:
        names = [name if name.isprintable() else ascii(name) for name in unknown]
        yield f"has attributes that are not used: {in_short(names)}."

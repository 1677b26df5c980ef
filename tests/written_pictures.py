"""Pictures of 8 and 16 bits for tests, and what OpenImageIO does not write by itself."""

import struct
import zlib
from pathlib import Path

import numpy as np
import OpenImageIO

KINDS = {"uint8": "uint8", "uint16": "uint16", "float16": "half", "float32": "float"}
COLOUR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}
"""Channels -> how PNG calls them: grey, grey and alpha, RGB, RGBA."""

ORIENTATION, EXIF_FOLDER = 0x0112, 0x8769
EXPOSURE_TIME, F_NUMBER, ISO, SHUTTER, APERTURE = 0x829A, 0x829D, 0x8827, 0x9201, 0x9202
STANDARD_OUTPUT, RECOMMENDED_INDEX, ISO_SPEED = 0x8831, 0x8832, 0x8833
BRIGHTNESS, BIAS, COLOUR_SPACE = 0x9203, 0x9204, 0xA001
SIGNED, LONG = (SHUTTER, BRIGHTNESS, BIAS), (EXIF_FOLDER, STANDARD_OUTPUT, RECOMMENDED_INDEX, ISO_SPEED)

CURVES = (b"rTRC", b"gTRC", b"bTRC")
COLORANTS = (b"rXYZ", b"gXYZ", b"bXYZ")


def write_picture(path: Path, pixels: np.ndarray, **notes: object) -> None:
    """A picture of the numbers given, row 0 at the bottom; its kind is that of the name."""
    height, width, channels = pixels.shape
    spec = OpenImageIO.ImageSpec(width, height, channels, KINDS[pixels.dtype.name])
    for name, value in notes.items():
        data = np.frombuffer(value, np.uint8) if isinstance(value, bytes) else value
        spec.attribute(name, *([f"uint8[{len(data)}]"] if isinstance(value, bytes) else []), data)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    spec.attribute("compression", "jpeg:100" if path.suffix == ".jpg" else "lossless")
    output = OpenImageIO.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    assert output.write_image(np.ascontiguousarray(pixels[::-1])), output.geterror()
    output.close()


def write_png(path: Path, pixels: np.ndarray, *chunks: tuple[bytes, bytes]) -> None:
    """A PNG of the whole numbers given, row 0 at the bottom, by the format's description: it says no more."""
    height, width, channels = pixels.shape
    rows = pixels[::-1].astype(pixels.dtype.newbyteorder(">"))
    raw = b"".join(b"\0" + row.tobytes() for row in rows)
    head = struct.pack(">IIBBBBB", width, height, 8 * pixels.itemsize, COLOUR_TYPE[channels], 0, 0, 0)
    parts = [(b"IHDR", head), *chunks, (b"IDAT", zlib.compress(raw)), (b"IEND", b"")]
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def add_exif(path: Path, fields: dict[int, int | tuple[int, int]], order: str = "<") -> None:
    """Put fields of Exif into a JPEG, a PNG or a WebP.

    Parameters
    ----------
    path : Path
    fields : dict
        Tag -> a whole number, or a fraction as a pair.
    order : str
        Of bytes: < or >.
    """
    block, picture = _tiff(fields, order), path.read_bytes()
    if path.suffix == ".jpg":
        segment = b"Exif\0\0" + block
        picture = picture[:2] + b"\xff\xe1" + struct.pack(">H", len(segment) + 2) + segment + picture[2:]
    elif path.suffix == ".png":
        picture = picture[:33] + _chunk(b"eXIf", block) + picture[33:]
    else:
        # WebP tells in a chunk before the picture that one of Exif follows it
        width, height = read_size(path)
        extended = (
            struct.pack("<I", 8) + (width - 1).to_bytes(3, "little") + (height - 1).to_bytes(3, "little")
        )
        parts = b"WEBP" + _riff(b"VP8X", extended) + picture[12:] + _riff(b"EXIF", block)
        picture = b"RIFF" + struct.pack("<I", len(parts)) + parts
    path.write_bytes(picture)


def read_size(path: Path) -> tuple[int, int]:
    """Width and height."""
    spec = OpenImageIO.ImageInput.open(str(path)).spec()
    return spec.width, spec.height


def _riff(kind: bytes, data: bytes) -> bytes:
    return kind + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)


def _tiff(fields: dict[int, int | tuple[int, int]], order: str) -> bytes:
    """The structure that Exif lies in: a folder of plain fields, and one of Exif's own."""
    plain = {tag: value for tag, value in fields.items() if tag == ORIENTATION}
    own = {tag: value for tag, value in fields.items() if tag != ORIENTATION}
    second = 8 + 2 + 12 * (len(plain) + 1) + 4
    values = second + 2 + 12 * len(own) + 4
    head = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(order + "I", 8)
    first = _folder(plain | {EXIF_FOLDER: second}, order, values)
    return head + first[0] + b"".join(_folder(own, order, values))


def _folder(fields: dict[int, int | tuple[int, int]], order: str, values: int) -> tuple[bytes, bytes]:
    """A folder, and the fractions that it points to from `values` on."""
    entries, fractions = struct.pack(order + "H", len(fields)), b""
    for tag, value in sorted(fields.items()):
        if isinstance(value, tuple):
            signed = "i" if tag in SIGNED else "I"
            entries += struct.pack(
                order + "HHII", tag, 10 if tag in SIGNED else 5, 1, values + len(fractions)
            )
            fractions += struct.pack(order + 2 * signed, *value)
        elif tag in LONG:
            entries += struct.pack(order + "HHII", tag, 4, 1, value)
        else:
            entries += struct.pack(order + "HHIHH", tag, 3, 1, value, 0)
    return entries + struct.pack(order + "I", 0), fractions


def profile(colorants: np.ndarray, curve: bytes) -> bytes:
    """An ICC profile of primaries with one curve.

    Parameters
    ----------
    colorants : ndarray, shape (3, 3)
        A row of XYZ, adapted to D50, for red, green and blue.
    curve : bytes
        A tag of type curv or para.
    """
    tags = {
        name: b"XYZ \0\0\0\0" + struct.pack(">3i", *(round(part * 65536) for part in row))
        for name, row in zip(COLORANTS, colorants, strict=True)
    }
    tags |= dict.fromkeys(CURVES, curve)
    places, body, start = b"", b"", 132 + 12 * len(tags)
    for name, data in tags.items():
        places += struct.pack(">4sII", name, start + len(body), len(data))
        body += data + bytes(-len(data) % 4)
    head = struct.pack(">I4sI4s4s4s", start + len(body), b"    ", 0x04000000, b"mntr", b"RGB ", b"XYZ ")
    head = head.ljust(36, b"\0") + b"acsp"
    return head.ljust(128, b"\0") + struct.pack(">I", len(tags)) + places + body


def parametric(kind: int, *numbers: float) -> bytes:
    """A curve of type para."""
    fixed = struct.pack(f">{len(numbers)}i", *(round(number * 65536) for number in numbers))
    return b"para\0\0\0\0" + struct.pack(">HH", kind, 0) + fixed


def sampled(*levels: int) -> bytes:
    """A curve of type curv."""
    return b"curv\0\0\0\0" + struct.pack(f">I{len(levels)}H", len(levels), *levels)


SRGB = parametric(3, 2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
P3 = np.array([[0.5151, 0.2412, -0.0011], [0.2919, 0.6922, 0.0419], [0.1572, 0.0666, 0.7841]])
"""Display P3's colorants as its published profile rounds them."""

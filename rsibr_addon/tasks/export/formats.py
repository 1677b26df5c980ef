"""The formats that map sets are exported in."""

from . import ktx2
from .format import Format

FORMATS: dict[str, Format] = {"ktx2": ktx2.FORMAT}
"""Name, a word, -> the format."""

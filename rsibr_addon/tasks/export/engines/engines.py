"""The engines that light is written for."""

from . import babylon, bevy, filament, three
from .engine import Engine

ENGINES: dict[str, Engine] = {
    "three": three.ENGINE,
    "babylon": babylon.ENGINE,
    "filament": filament.ENGINE,
    "bevy": bevy.ENGINE,
}
"""Name, a word, -> the engine."""

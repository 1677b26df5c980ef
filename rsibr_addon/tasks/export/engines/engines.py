"""The engines that light is written for."""

from . import babylon, bevy, filament, gltf, three
from .engine import Engine

ENGINES: dict[str, Engine] = {
    "three": three.ENGINE,
    "babylon": babylon.ENGINE,
    "filament": filament.ENGINE,
    "bevy": bevy.ENGINE,
    "gltf": gltf.ENGINE,
}
"""Name, a word, -> the engine."""

"""The engines that light is written for."""

from . import any_engine, babylon, bevy, filament, gltf, panoramas, three
from .engine import Engine

ENGINES: dict[str, Engine] = {
    "three": three.ENGINE,
    "babylon": babylon.ENGINE,
    "filament": filament.ENGINE,
    "bevy": bevy.ENGINE,
    "gltf": gltf.ENGINE,
    "unity": panoramas.UNITY,
    "unreal": panoramas.UNREAL,
    "godot": panoramas.GODOT,
    "any": any_engine.ENGINE,
}
"""Name, a word, -> the engine."""

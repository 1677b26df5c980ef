"""The engines that light is written for."""

from . import any_engine, babylon, bevy, filament, gltf, lobes, panoramas, three
from .engine import CubeEngine, PanoramaEngine
from .lobes import LobesEngine

Engine = CubeEngine | PanoramaEngine | LobesEngine
"""An engine, by what it takes."""

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
    "lobes": lobes.ENGINE,
}
"""Name, a word, -> the engine."""

"""The engines that light is written for."""

from . import bevy, filament
from .engine import Engine

ENGINES: dict[str, Engine] = {"filament": filament.ENGINE, "bevy": bevy.ENGINE}
"""Name, a word, -> the engine."""

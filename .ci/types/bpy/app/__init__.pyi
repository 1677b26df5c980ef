from typing import Any

from . import handlers as handlers

binary_path: str
tempdir: str

def __getattr__(name: str) -> Any: ...

# What mypy is told of Blender: its types by name and rank, and Any for most of what they hold.
# docs/architecture.md says why.
from typing import Any

from . import app as app
from . import path as path
from . import props as props
from . import types as types
from . import utils as utils

context: types.Context
data: types.BlendData
ops: Any

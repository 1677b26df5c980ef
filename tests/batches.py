"""A batch of some materials in some environments, for tests of batches."""

import json
from pathlib import Path
from typing import Any

ENVIRONMENTS = ("dawn", "noon", "dusk")
MATERIALS = ("chrome", "matte", "satin")


def write_batch(**changed: Any) -> Path:
    """Write a batch of all, but for the fields that are changed."""
    batch = {
        "environments": ["light/*.exr"],
        "materials": [*MATERIALS],
        "methods": [{"kind": "reflection-tables", "diffuse_rows": 4, "rows": 4}],
        "output": "maps/{environment}-{material}.rsibr.exr",
    }
    path = Path("metals.json")
    path.write_text(json.dumps(batch | changed))
    return path

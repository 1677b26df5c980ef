"""Show balls in `forest` as engines in a browser show exported light; writes docs/images/engine-*.jpg.

tests/web holds the pages; what these need, `.ci/web/engines` installs.
"""

import base64
import tempfile
from pathlib import Path

from docs_table import DOCS
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.rsibr_addon.tasks.light.environments import environment_file
from rsibr.tests.web.browser import asked

FILES = {"three": "forest-three.ktx2", "lobes": "forest.ktx2", "babylon": "forest.env"}
"""Engine -> what is exported for it."""

ASKED = {"three": "forest-three.ktx2", "lobes": "forest", "babylon": "forest.env"}
"""Engine -> what its page is asked for."""


def main() -> None:
    """Export for all, and write their pictures."""
    with tempfile.TemporaryDirectory() as name:
        folder, forest = Path(name), Path(environment_file("forest"))
        for engine, file in FILES.items():
            drain(export_for_engine(forest, folder / file, engine))
        for engine, file in ASKED.items():
            shown = asked(f"picture_{engine}.html", {"file": f"/files/{file}"}, folder)["picture"]
            picture = base64.b64decode(shown.partition(",")[2])
            (DOCS / "images" / f"engine-{engine}.jpg").write_bytes(picture)


if __name__ == "__main__":
    main()

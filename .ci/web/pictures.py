"""Make the pictures of the pages on engines: docs/images/engine-NAME.jpg. Needs .ci/web/engines install.

.venv/bin/python .ci/web/pictures.py
"""

import base64
import tempfile
from pathlib import Path

import bpy
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.tasks.export.engines.export import export_for_engine
from rsibr.tests.web.browser import asked

WORLDS = Path(bpy.utils.system_resource("DATAFILES")) / "studiolights" / "world"
IMAGES = Path(__file__).parents[2] / "docs" / "images"

with tempfile.TemporaryDirectory() as folder:
    drain(export_for_engine(WORLDS / "forest.exr", Path(folder) / "lit-three.ktx2", "three"))
    for name, file, shown in (
        ("three", "forest.ktx2", "forest.ktx2"),
        ("babylon", "forest.env", "forest.env"),
        ("lobes", "lit.ktx2", "lit"),
    ):
        drain(export_for_engine(WORLDS / "forest.exr", Path(folder) / file, name))
        said = asked(f"picture_{name}.html", {"file": f"/files/{shown}"}, Path(folder))
        picture = said["picture"].partition(",")[2]
        (IMAGES / f"engine-{name}.jpg").write_bytes(base64.b64decode(picture))

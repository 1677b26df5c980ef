"""A map set opened as a picture by Blender itself, whose loader takes the first part's size for all."""

import subprocess
import sys
from pathlib import Path

from rsibr.tests.files.test_export import chain_file

LOOK = """
import sys
import bpy
image = bpy.data.images.load(sys.argv[1])
loaded = image.depth, tuple(image.size)
print(image.type, *loaded)
"""


def test_blender_can_open_a_map_set_whose_first_map_is_not_the_largest(tmp_path: Path) -> None:
    # In a process of its own: it used to end in the middle
    command = [sys.executable, "-c", LOOK, str(chain_file(tmp_path))]
    look = subprocess.run(command, capture_output=True, text=True, check=False)
    assert look.returncode == 0, look.stderr
    assert look.stdout.splitlines()[-1].startswith("MULTILAYER")

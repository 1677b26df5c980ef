"""A Blender of its own with the built extension."""

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

type Blender = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def extension() -> Path:
    """The zip, freshly built."""
    subprocess.run([sys.executable, ROOT / ".ci" / "build_extension.py"], check=True)
    (archive,) = (ROOT / "dist").glob("rsibr-*.zip")
    return archive


@pytest.fixture(scope="session")
def blender(extension: Path, blender_window: Path, tmp_path_factory: pytest.TempPathFactory) -> Blender:
    """Blender with the extension installed and enabled; sees the folder of its files as /job."""
    folder = tmp_path_factory.mktemp("blender")
    shutil.copy(extension, folder / "extension.zip")

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        # The bpy module has set OCIO to its own files, which are not this Blender's.
        environment = {name: value for name, value in os.environ.items() if name != "OCIO"}
        command = [blender_window, folder, *arguments]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, timeout=300
        )

    install = run("--command", "extension", "install-file", "-r", "user_default", "-e", "/job/extension.zip")
    assert install.returncode == 0, install.stderr
    return run

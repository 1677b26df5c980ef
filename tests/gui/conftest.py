"""A Blender of its own with the built extension."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
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
def job(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The folder that Blender sees as /job."""
    folder = tmp_path_factory.mktemp("blender")
    yield folder
    # Mounted there, it could not be removed.
    root = Path(os.environ.get("WINDOW_ROOT", Path.home() / ".cache" / "blender-window"))
    subprocess.run(["umount", root / "sid" / "job"], check=True)


@pytest.fixture(scope="session")
def blender(extension: Path, blender_window: Path, job: Path) -> Blender:
    """Blender with the extension installed and enabled."""
    folder = job
    shutil.copy(extension, folder / "extension.zip")

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        # The bpy module has set OCIO to its own files, which are not this Blender's.
        environment = {name: value for name, value in os.environ.items() if name != "OCIO"}
        command = [blender_window, folder, *arguments]
        return subprocess.run(
            command, env=environment, capture_output=True, text=True, check=False, timeout=600
        )

    install = run("--command", "extension", "install-file", "-r", "user_default", "-e", "/job/extension.zip")
    assert install.returncode == 0, install.stderr
    return run


@pytest.fixture
def told(blender: Blender, blender_window: Path, job: Path) -> Callable[[str], dict]:
    """Run a scenario of `in_window` in Blender's window, and say what it told."""
    shutil.copy(Path(__file__).with_name("in_window.py"), job)
    shutil.copy(blender_window.with_name("xshot.py"), job)

    def run(scenario: str) -> dict:
        script = (
            f"import sys\nsys.path.insert(0, '/job')\nfrom in_window import *\n{scenario}\nrun(scenario)\n"
        )
        process = blender("--window", "--enable-event-simulate", "--python-expr", script)
        lines = [line for line in process.stdout.splitlines() if line.startswith("TOLD ")]
        assert lines, process.stdout + process.stderr
        answer = json.loads(lines[0].removeprefix("TOLD "))
        assert "error" not in answer, answer["error"]
        assert "Traceback" not in process.stdout + process.stderr
        return answer

    return run

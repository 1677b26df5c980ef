"""A Blender of its own with the built extension."""

import json
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from rsibr.tests.conftest import BLENDER_WINDOW

ROOT = Path(__file__).parents[2]

Blender = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def extension() -> Path:
    """The zip, freshly built."""
    subprocess.run([sys.executable, ROOT / ".ci" / "build_extension.py"], check=True)
    version = tomllib.loads((ROOT / "blender_manifest.toml").read_text())["version"]
    return ROOT / "dist" / f"rsibr-{version}.zip"


@pytest.fixture(scope="session")
def job(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that Blender sees as /job."""
    return tmp_path_factory.mktemp("blender")


@pytest.fixture(scope="session")
def blender(extension: Path, job: Path) -> Blender:
    """Blender with the extension installed and enabled."""
    shutil.copy(extension, job / "extension.zip")

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [BLENDER_WINDOW, "run", job, *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)

    install = run("--command", "extension", "install-file", "-r", "user_default", "-e", "/job/extension.zip")
    assert install.returncode == 0, install.stderr
    return run


@pytest.fixture
def told(blender: Blender, job: Path) -> Callable[..., dict]:
    """Run a scenario of `in_window` in Blender's window, and say what it told.

    Its events are simulated, and then Blender takes none of the keyboard's, or all are the keyboard's.
    """
    scripts = job / "user" / "scripts" / "startup"
    scripts.mkdir(parents=True, exist_ok=True)
    here = Path(__file__).parent
    for source, folder in (("in_window.py", job), ("xshot.py", job), ("held.py", scripts)):
        shutil.copy(here / source, folder)
    (job / "hold").unlink(missing_ok=True)
    for left in list(job.glob("user/**/*.partial")):  # holds count the views of all captures
        shutil.rmtree(left)

    def run(scenario: str, by_keyboard: bool = False) -> dict:
        script = (
            f"import sys\nsys.path.insert(0, '/job')\nfrom in_window import *\n{scenario}\nrun(scenario)\n"
        )
        events = [] if by_keyboard else ["--enable-event-simulate"]
        process = blender("--window", *events, "--python-expr", script)
        lines = [line for line in process.stdout.splitlines() if line.startswith("TOLD ")]
        assert lines, f"Blender ended with {process.returncode}: {process.stdout}{process.stderr}"
        answer = json.loads(lines[0].removeprefix("TOLD "))
        assert "error" not in answer, answer["error"] + process.stdout + process.stderr
        assert "Traceback" not in process.stdout + process.stderr
        return answer

    return run

"""Build and validate the extension's zip with Blender's own tool, from the working tree."""

import re
import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import bpy
from own_symbols import bind_wheel_to_itself

ROOT = Path(__file__).resolve().parents[1]
SCRIPTS = Path(bpy.utils.resource_path("LOCAL")) / "scripts"
BLENDER_EXT = SCRIPTS / "addons_core" / "bl_pkg" / "cli" / "blender_ext.py"
TAGS = SCRIPTS / "modules" / "_bpy_internal" / "extensions" / "tags.py"


def fetch_wheel(path: Path) -> None:
    """Download the wheel that the name of `path` says, as its project published it."""
    package, version, python, abi, platform = path.stem.split("-")
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]
    command += ["--implementation", "cp", "--python-version", re.sub(r"cp(\d)(\d+)", r"\1.\2", python)]
    newest = platform.split(".")[-1]  # of the systems that a wheel names
    command += ["--abi", abi, "--platform", newest, "--dest", str(path.parent), f"{package}=={version}"]
    subprocess.run(command, check=True)


def blender_ext(*arguments: str) -> None:
    """Run Blender's command for building extensions."""
    subprocess.run([sys.executable, str(BLENDER_EXT), *arguments], check=True)


def main() -> None:
    """Fetch the wheels that are not there yet, build dist/ID-VERSION.zip and validate it."""
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    for wheel in manifest["wheels"]:
        if not (ROOT / wheel).exists():
            print(f"Fetching {Path(wheel).name}")
            fetch_wheel(ROOT / wheel)
        # Blender has an OpenEXR of its own
        if fnmatch(Path(wheel).name, "openexr-*linux*"):
            bind_wheel_to_itself(ROOT / wheel)
    archive = ROOT / "dist" / f"{manifest['id']}-{manifest['version']}.zip"
    archive.parent.mkdir(exist_ok=True)
    blender_ext(
        "build", "--source-dir", str(ROOT), "--output-filepath", str(archive), "--valid-tags", str(TAGS)
    )
    blender_ext("validate", "--valid-tags", str(TAGS), str(archive))


if __name__ == "__main__":
    main()

"""What tests need: a test's folder says it, and here it is looked for and prepared.

A dependency that is missing skips its tests, and the run's summary says which and why. Named in the
environment variable RSIBR_REQUIRE (comma-separated: gl, bpy, cycles, farm, gui, web, and `PROGRAMS`), it
fails them instead. Named in RSIBR_WITHOUT, it is not looked for, and its tests are not collected.
"""

import functools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
BLENDER_WINDOW = TESTS.parent / ".ci" / "window" / "blender"
"""A Blender of the tests' own: the file says how to call it."""

WEB_ENGINES = TESTS.parent / ".ci" / "web" / "engines"
"""A browser, and engines to load in it."""

NEEDS = {
    "glsl": ("gl",),
    "blender": ("bpy",),
    "cycles": ("bpy", "cycles"),
    "farm": ("bpy", "cycles", "farm"),
    "gui": ("gui",),
    "web": ("bpy", "gl", "web"),
}
"""Folder of tests -> what its tests need; the other folders need numpy and OpenEXR only."""

PROGRAMS = ("node", "cmgen", "naga", "glslangValidator")
"""What tests marked `needs` run: JavaScript, Filament's filter, compilers of shaders."""


def _start_bpy() -> None:
    import bpy  # noqa: F401


def _start_gl() -> None:
    from rsibr.rsibr_addon.device.context import ensure_context

    ensure_context()


def _start_cycles() -> None:
    import bpy

    bpy.context.scene.render.engine = "CYCLES"


def _start_farm() -> None:
    folder = os.environ.get("FLAMENCO")
    if not folder:
        raise LookupError("FLAMENCO names no folder of flamenco-manager and flamenco-worker")
    for name in ("flamenco-manager", "flamenco-worker"):
        if not os.access(Path(folder) / name, os.X_OK):
            raise LookupError(f"FLAMENCO={folder} has no program {name}")


def _start_gui() -> None:
    def run(*arguments: str) -> None:
        process = subprocess.run([BLENDER_WINDOW, *arguments], capture_output=True, text=True, check=False)
        if process.returncode:
            raise OSError(process.stderr.strip())

    if "gui" not in required():
        raise LookupError("only `make test-gui` asks for it")
    with tempfile.TemporaryDirectory() as folder:
        run("install")
        run("run", folder, "--window", "--python-expr", "import os; os._exit(0)")


def _start_web() -> None:
    process = subprocess.run([WEB_ENGINES, "check"], capture_output=True, text=True, check=False)
    if process.returncode:
        raise OSError(process.stderr.strip())


def _find(program: str) -> None:
    if shutil.which(program) is None:
        raise LookupError("no such program is installed")


START: dict[str, Callable[[], None]] = {
    "bpy": _start_bpy,
    "gl": _start_gl,
    "cycles": _start_cycles,
    "farm": _start_farm,
    "gui": _start_gui,
    "web": _start_web,
    **{program: functools.partial(_find, program) for program in PROGRAMS},
}


@functools.cache
def absence(dependency: str) -> str | None:
    """Why `dependency` cannot be had, in words, or None when it can."""
    try:
        START[dependency]()
    except Exception as error:  # whatever goes wrong is the reason to report
        return f"{dependency} is missing: {error}"
    return None


def required() -> set[str]:
    """What RSIBR_REQUIRE names."""
    return _named("RSIBR_REQUIRE")


def left_out() -> set[str]:
    """What RSIBR_WITHOUT names."""
    return _named("RSIBR_WITHOUT")


def _named(variable: str) -> set[str]:
    """The dependencies that a variable of the environment names."""
    named = set(os.environ.get(variable, "").replace(",", " ").split())
    if unknown := named - START.keys():
        pytest.exit(f"{variable} names {', '.join(sorted(unknown))}; it knows {', '.join(START)}", 1)
    return named


def require(dependencies: tuple[str, ...]) -> None:
    """Skip, or fail where RSIBR_REQUIRE names it, when one of `dependencies` is missing."""
    for dependency in dependencies:
        if reason := absence(dependency):
            if dependency in required():
                pytest.fail(f"{reason} (and RSIBR_REQUIRE asks for it)", pytrace=False)
            pytest.skip(reason, allow_module_level=True)


def folder_needs(path: Path) -> tuple[str, ...]:
    """What the folder of the test file `path`, or the folder `path`, promises to its tests."""
    return NEEDS.get(next(iter(path.relative_to(TESTS).parts), ""), ())


class CheckedModule(pytest.Module):
    """A test file that is only imported when what its folder needs is there."""

    def collect(self) -> list[pytest.Item | pytest.Collector]:
        require(folder_needs(self.path))
        return list(super().collect())


@pytest.fixture
def registered() -> Iterator[None]:
    """Have the extension registered in Blender."""
    import rsibr

    rsibr.register()
    yield
    rsibr.unregister()


@pytest.fixture
def quick_furnace(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have captures measure albedos by few samples, which takes a twentieth of the time."""
    from rsibr.rsibr_addon.host import furnace

    monkeypatch.setattr(furnace, "SAMPLES", 4)


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> pytest.Module:
    return CheckedModule.from_parent(parent, path=module_path)


def pytest_ignore_collect(collection_path: Path) -> bool | None:
    within = collection_path.is_relative_to(TESTS)
    return True if within and left_out() & set(folder_needs(collection_path)) else None


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    needless = [item for item in items if left_out() & set(_marked(item))]
    config.hook.pytest_deselected(items=needless)
    items[:] = [item for item in items if item not in needless]


def pytest_runtest_setup(item: pytest.Item) -> None:
    require(_marked(item))


def _marked(item: pytest.Item) -> tuple[str, ...]:
    """What a test needs beyond what its folder says."""
    return tuple(name for marker in item.iter_markers("needs") for name in marker.args)


@pytest.fixture(autouse=True)
def _factory_file(request: pytest.FixtureRequest) -> None:
    """Start tests that may use Blender's data with its factory file: a cube, a light, a camera."""
    if "bpy" in folder_needs(request.path):
        import bpy

        bpy.ops.wm.read_factory_settings()

"""Who may know whom, by the imports of every module; and what the manifest and the package agree on."""

import ast
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from fnmatch import fnmatch
from pathlib import Path

import pytest
from rsibr.rsibr_addon.files.kinds.registry import STORED

ROOT = Path(__file__).parents[1]

LAYERS: dict[str, set[str]] = {
    "core": set(),
    "settings": {"core"},
    "job": {"core", "settings", "files"},
    "files": {"core", "settings"},
    "host": {"core", "files"},
    "device": {"core"},
    "tasks": {"core", "settings", "job", "files", "host", "device"},
    "command_line": {"core", "settings", "job", "files", "host", "device", "tasks"},
    "session": {"core", "files", "host", "tasks"},
    "operators": {"core", "settings", "job", "files", "host", "device", "tasks", "session"},
    "properties": {"core", "settings", "files", "host"},
    "ui": {"core", "settings", "job", "files", "host", "device", "tasks", "session", "properties"},
    "registration": {"command_line", "host", "session", "operators", "properties", "ui"},
    "__init__": {"registration"},
}
"""Layer -> the other layers of ours that it may import."""

THIRD_PARTY: dict[str, set[str]] = {
    "core": {"numpy", "ducc0"},
    "settings": set(),
    "job": set(),
    "files": {"numpy", "OpenEXR", "OpenImageIO"},
    "host": {"numpy", "bpy", "bmesh", "mathutils"},
    "device": {"numpy", "bpy", "blf", "gpu", "gpu_extras", "mathutils"},
    "tasks": {"numpy"},
    "command_line": {"numpy"},
    "session": {"bpy"},
    "operators": {"bpy"},
    "properties": {"bpy"},
    "ui": {"bpy"},
    "registration": {"bpy"},
    "__init__": set(),
}
"""Layer -> what it may import besides the standard library."""

MODULES = sorted(
    path
    for path in [
        ROOT / "__init__.py",
        *(ROOT / "operators").rglob("*.py"),
        *(ROOT / "rsibr_addon").rglob("*.py"),
    ]
    if path != ROOT / "rsibr_addon" / "__init__.py"
)


def test_the_page_on_architecture_has_this_table() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    told: dict[str, set[str]] = {}
    for name, last in re.findall(
        r"^\| ([a-z ]+) \|.*\| ([^|]+) \|$", page.partition("## The way")[0], re.MULTILINE
    ):
        ours, _, besides = last.partition("all above")
        named = {each.strip().replace(" ", "_") for each in re.split("[,;]", ours)} & LAYERS.keys()
        above = told.keys() - ({"command_line"} if "but the command line" in besides else set())
        told[name.replace(" ", "_")] = named or (set(above) if "all above" in last else set())
    assert told == {layer: others for layer, others in LAYERS.items() if layer != "__init__"}


def layer_of(dotted: tuple[str, ...]) -> str:
    """Layer of a module, by its path from the root: ("rsibr_addon", "core", "camera") -> "core"."""
    inner = dotted[1:] if dotted[:1] == ("rsibr_addon",) else dotted
    return inner[0] if inner else "__init__"


def dotted_name(path: Path) -> tuple[str, ...]:
    """Path of a module from the root, without suffix: ("rsibr_addon", "core", "camera")."""
    return path.relative_to(ROOT).with_suffix("").parts


def imports(path: Path) -> Iterator[tuple[int, tuple[str, ...]]]:
    """Each import of a module, lazy ones too: (dots of a relative import, dotted name from the root)."""
    package = dotted_name(path)[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((0, tuple(alias.name.split("."))) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            base += tuple(node.module.split(".")) if node.module else ()
            names = [()] if node.module else [(alias.name,) for alias in node.names]
            yield from ((node.level, base + name) for name in names)


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_imports_only_what_its_layer_may(path: Path) -> None:
    layer = layer_of(dotted_name(path))
    for level, name in imports(path):
        if level:
            other = layer_of(name)
            assert other in LAYERS[layer] | {layer}, f"{layer} imports {'.'.join(name)}"
        else:
            allowed = sys.stdlib_module_names | THIRD_PARTY[layer]
            assert name[0] in allowed, f"{layer} imports {name[0]}"


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_stays_readable(path: Path) -> None:
    assert len(path.read_text().splitlines()) <= 400
    assert "utils" not in "".join(dotted_name(path))


OF_KINDS = (
    "core/*",
    "*/kinds/*",
    "settings/*",
    "tasks/methods/*",
    "tasks/compare/*",
    "tasks/export/engines/*",
)
"""Modules below rsibr_addon that may know a kind of map sets: each kind's own, the registries, and engines,
which take mip chains alone."""

EXCEPTIONS = {
    "operators/bake_kinds": "has the operators' names of version 0.1",
    "tasks/reflectance/material_picture": "shades materials as previews do, from a kernel pyramid",
    "tasks/viewport/map_sets": "draws light that is rendered live as a mip chain",
}


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_only_its_own_modules_and_the_registries_know_a_kind(path: Path) -> None:
    where = "/".join(dotted_name(path)).removeprefix("rsibr_addon/")
    if any(fnmatch(where, pattern) for pattern in OF_KINDS) or where in EXCEPTIONS:
        return
    named = {word for _, name in imports(path) for word in name}
    for node in ast.walk(ast.parse(path.read_text())):
        match node:
            case ast.Constant(value=str(word)) | ast.Attribute(attr=word):
                named.add(word)
            case ast.ImportFrom(names=names):
                named |= {alias.name for alias in names}
    assert not [kind for kind in STORED for word in named if kind in word]


@pytest.mark.parametrize(
    "path", sorted((ROOT / "rsibr_addon" / "host").glob("*.py")), ids=lambda path: path.stem
)
def test_host_s_modules_import_bpy_before_what_it_brings(path: Path) -> None:
    names = [imported[0] for _, imported in imports(path)]
    brought = [names.index(name) for name in ("bmesh", "mathutils") if name in names]
    assert not brought or names.index("bpy") < min(brought)


def test_state_of_the_running_extension_is_its_session_s() -> None:
    found = set()
    for path in MODULES:
        if layer_of(dotted_name(path)) in {"tasks", "session", "operators", "ui"}:
            for node in ast.parse(path.read_text()).body:
                if isinstance(node, ast.Assign | ast.AnnAssign):
                    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                    names = {name.id for each in targets for name in ast.walk(each) if hasattr(name, "id")}
                    found |= {(path.stem, name) for name in names if name.strip("_")[0].islower()}
    # Blender keeps no copy of an enumeration's words
    assert found == {("running", "_running"), ("bake_properties", "_studios")}


def test_everything_but_blenders_layers_imports_without_blender_and_photographs() -> None:
    modules = [
        ".".join(("rsibr", *dotted_name(path))).removesuffix(".__init__")
        for path in MODULES
        if layer_of(dotted_name(path))
        not in {"host", "device", "tasks", "session", "operators", "properties", "ui"}
    ]
    hidden = "import sys; sys.modules.update(bpy=None, gpu=None, mathutils=None, OpenImageIO=None)\n"
    script = hidden + "".join(f"import {module}\n" for module in modules)
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr


def test_manifest_and_package_agree() -> None:
    manifest = tomllib.loads((ROOT / "blender_manifest.toml").read_text())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert manifest["version"] == project["version"]
    assert manifest["license"] == [f"SPDX:{project['license']}"]
    # The tests run with the packages that the zip ships, on each platform and for both Pythons
    constraints = (ROOT / ".ci" / "constraints.txt").read_text().splitlines()
    pinned = dict(line.split("==") for line in constraints if "==" in line)
    packages = {(name.lower(), pinned[name]) for name in ("OpenEXR", "OpenImageIO", "ducc0")}
    wheels = [Path(wheel).stem.split("-") for wheel in manifest["wheels"]]
    assert {(name, version) for name, version, *_ in wheels} == packages
    systems = ("manylinux*_x86_64", "macosx*_arm64", "win_amd64")
    expected = [(*each, py, system) for each in packages for py in ("cp313", "cp314") for system in systems]
    for *package, python, system in expected:
        fits = [wheel[:2] == package and wheel[3] == python and fnmatch(wheel[4], system) for wheel in wheels]
        assert sum(fits) == 1
    assert len(wheels) == len(expected)

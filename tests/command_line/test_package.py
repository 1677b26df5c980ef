"""The installed package is whole: what a wheel lacks is missed only where it is used."""

from pathlib import Path

import rsibr

ROOT = Path(__file__).parents[2]


def test_the_package_holds_all_modules_and_data_of_the_checkout() -> None:
    folders = ("rsibr_addon", "operators", "gpu_shaders")
    wanted = [
        path for folder in folders for path in (ROOT / folder).rglob("*") if path.suffix not in ("", ".pyc")
    ]
    assert {".py", ".glsl", ".html", ".npz"} <= {path.suffix for path in wanted}
    wanted += [ROOT / "__init__.py", ROOT / "blender_manifest.toml"]
    installed = Path(rsibr.__path__[0])
    assert [path for path in wanted if not (installed / path.relative_to(ROOT)).is_file()] == []

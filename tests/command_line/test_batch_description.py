"""Batches: the bakes that a file stands for."""

import json
from pathlib import Path
from typing import Any

import pytest
from rsibr.rsibr_addon.core.brdf.gallery import GALLERY
from rsibr.rsibr_addon.core.errors import InputFileError
from rsibr.rsibr_addon.tasks.batch.description import read_batch
from rsibr.tests.batches import ENVIRONMENTS, MATERIALS, write_batch

pytestmark = pytest.mark.usefixtures("light_folder")


def outputs(path: Path) -> list[str]:
    return [Path(each.job.output).name for each in read_batch(path)]


def test_it_stands_for_all_materials_in_all_environments() -> None:
    found = outputs(write_batch())
    wanted = {f"{light}-{material}.rsibr.exr" for light in ENVIRONMENTS for material in MATERIALS}
    assert (set(found), len(found)) == (wanted, 9)
    # One environment after the other
    assert [name.partition("-")[0] for name in found] == sorted(3 * ENVIRONMENTS)


def test_methods_of_light_alone_take_no_material_and_sizes_multiply() -> None:
    path = write_batch(methods=["mip-chain"], sizes=[4, 8], output="{environment}-{size}.exr")
    assert sorted(outputs(path)) == sorted(f"{light}-{size}.exr" for light in ENVIRONMENTS for size in (4, 8))


def test_map_sets_beside_environments_are_none() -> None:
    path = write_batch(
        methods=["mip-chain"], environments=["light/*.exr"], output="light/{environment}.rsibr.exr"
    )
    before = outputs(path)
    Path("light/dawn.rsibr.exr").touch()
    assert outputs(path) == before


def test_what_a_batch_names_is_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_batch(environments=["light/dawn.exr", "light/noon.exr:Sky", "forest"]).resolve()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    bakes = read_batch(path)
    beside = {f"{tmp_path}/light/dawn.exr", f"{tmp_path}/light/noon.exr:Sky", "forest"}
    assert {each.job.light.environment for each in bakes} == beside
    assert {Path(each.job.output).parent for each in bakes} == {tmp_path / "maps"}


def test_materials_are_what_each_method_takes() -> None:
    Path("gold.binary").touch()
    materials = ["copper", "Chrome", "*.binary", "car.blend:Red/dark", "ggx:alpha=0.2,f0=0.5"]
    path = write_batch(materials=materials, methods=["lobe-stack"], environments=["light/dawn.exr"])
    bakes = read_batch(path)
    assert [each.job.settings.brdf for each in bakes] == [
        "blend:copper",
        "ggx:alpha=0.04,metal=chromium",
        "merl:path=gold.binary",
        "blend:car.blend:Red/dark",
        "ggx:alpha=0.2,f0=0.5",
    ]
    assert [Path(each.job.output).name for each in bakes] == [
        f"dawn-{name}.rsibr.exr" for name in ("copper", "Chrome", "gold", "Red-dark", "ggx-alpha-0.2-f0-0.5")
    ]
    path = write_batch(materials=materials[3:4], methods=["radiance-views"])
    assert read_batch(path)[0].job.settings.material == "car.blend:Red/dark"


def test_a_table_has_a_bake_or_a_pattern_a_row() -> None:
    path = Path("rows.csv")
    path.write_text(
        "environment,material,method,rows,exact,output\n"
        "light/*.exr,matte,reflection-tables,8,,\n"
        "light/dawn.exr,chrome,reflection-tables,,true,{material}.exr\n"
    )
    bakes = read_batch(path)
    assert sorted(Path(each.job.output).name for each in bakes) == [
        "chrome.exr",
        *(f"{light}-matte.rsibr.exr" for light in sorted(ENVIRONMENTS)),
    ]
    settings = {Path(each.job.output).stem: each.job.settings for each in bakes}
    assert (settings["chrome"].rows, settings["chrome"].exact) == (None, True)
    assert settings["noon-matte.rsibr"].rows == 8


def test_a_table_of_excel_is_read() -> None:
    path = Path("excel.csv")
    # With its mark of UTF-8, its ends of lines, semicolons, and an empty row
    path.write_bytes(
        "\ufeffEnvironment;Method;Material;exact;Fit\r\n"
        " light/dawn.exr ;reflection-tables;chrome;yes;\r\n;;;;\r\n".encode()
    )
    bakes = read_batch(path)
    assert [each.title for each in bakes] == ["chrome in dawn"]
    assert bakes[0].job.settings.exact


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_a_table_with_decimal_commas_is_read(encoding: str) -> None:
    path = Path("excel.csv")
    specular = "phong:n=20,ks=0.3"  # no number: its comma stays
    path.write_text(
        f"environment;method;clamp;error;brdf\nlight/dawn.exr;lobe-stack;0,5;1,5e-2;{specular}\n",
        encoding=encoding,
    )
    (job,) = (each.job for each in read_batch(path))
    assert (job.light.clamp, job.settings.error, job.settings.brdf) == (0.5, 0.015, specular)


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        (
            "light/dawn.exr,lobe-stack,ward:alpha=0.3,ks=0.5,8",
            "line 2 has more cells than columns: put quotes",
        ),
        ("light/dawn.exr,reflection-tables,,maybe", "exact of line 2: 'maybe' is neither true nor false"),
        ("\n,mip-chain,,", "line 3 has no environment"),
        ("light/dawn.exr,mips,,", "there is no method mips: choose one of .*mip-chain"),
    ],
)
def test_what_is_wrong_with_a_table_is_a_sentence(rows: str, sentence: str) -> None:
    Path("rows.csv").write_text(f"environment,method,material,exact\n{rows}\n")
    with pytest.raises(InputFileError, match=sentence):
        read_batch(Path("rows.csv"))


def test_files_that_settings_name_are_beside_the_batch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("fit.json").touch()
    path = write_batch(
        materials=[], methods=[{"kind": "lobe-stack", "fit": "fit.json"}], environments=["light/dawn.exr"]
    ).resolve()
    Path("spec.json").write_text(
        json.dumps(
            {
                "environments": ["dark.exr"],
                "methods": ["lobe-stack"],
                "materials": ["merl:path = a/b.binary"],
            }
        )
    )
    probes = {
        "kind": "mip-chain",
        "probes": "box:light=hall.exr,size=6/5/3;sphere:size=1/1/1, light = b/c.exr ;box:light=forest",
    }
    Path("rooms.json").write_text(json.dumps({"environments": ["dark.exr"], "methods": [probes]}))
    monkeypatch.chdir("light")
    [bake] = read_batch(path)
    assert bake.job.settings.fit == f"{tmp_path}/fit.json"
    [rooms] = read_batch(tmp_path / "rooms.json")
    assert [each.light for each in rooms.job.settings.rooms] == [
        f"{tmp_path}/hall.exr",
        f"{tmp_path}/b/c.exr",
        "forest",
    ]
    [spec] = read_batch(tmp_path / "spec.json")
    assert spec.job.settings.brdf == f"merl:path={tmp_path}/a/b.binary"
    assert spec.job.light.environment == f"{tmp_path}/dark.exr"
    assert Path(spec.job.output).name == "dark-merl-path-b.binary.rsibr.exr"


def test_what_two_patterns_mean_is_baked_once() -> None:
    twice = ["light/*.exr", "light/dawn.exr", "light/d*.exr"]
    path = write_batch(environments=twice, methods=["mip-chain", "mip_chain"], output="{environment}.exr")
    assert sorted(outputs(path)) == [f"{light}.exr" for light in sorted(ENVIRONMENTS)]


def test_a_file_that_is_called_like_a_pattern_is_meant_alone() -> None:
    Path("light/[dn].exr").touch()
    path = write_batch(environments=["light/[dn].exr"], methods=["mip-chain"], output="{environment}.exr")
    assert outputs(path) == ["dn.exr"]


def test_an_empty_name_takes_its_dash_along() -> None:
    path = write_batch(methods=["mip-chain"], output="{environment}-{material}.rsibr.exr")
    assert sorted(outputs(path)) == [f"{light}.rsibr.exr" for light in sorted(ENVIRONMENTS)]


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"environments": []}, "it has no environment and method"),
        ({"output": "{environment}-{material}"}, "does not end in .exr"),
        ({"environments": ["none/*.exr"]}, r"Nothing is called none/\*\.exr"),
        ({"environments": [""]}, "an environment has no name"),
        ({"methods": ["baking"]}, "there is no method baking: choose one of"),
        ({"methods": ["mipchain"]}, r"no method mipchain \(did you mean mip-chain\?\): choose one of"),
        ({"output": "{light}.exr"}, "output names {light}, which is none of environment, material"),
        ({"output": "{material!r}.exr"}, "output names {material!r}, which is none of environment, material"),
        ({"output": "{material.exr"}, "output {material.exr has a brace without another"),
        (
            {"output": "{material}.exr"},
            r"metals\.json makes .*chrome\.exr of chrome in dawn and of chrome in",
        ),
        ({"methods": [{"kind": "mip-chain", "size": 3}]}, "mip_chain is impossible"),
        ({"colour": 1}, "colour is unknown"),
        ({"size": [64]}, r"size is unknown \(did you mean sizes\?\)"),
    ],
)
def test_what_is_wrong_with_a_batch_is_a_sentence(changed: dict[str, Any], sentence: str) -> None:
    with pytest.raises(InputFileError, match=sentence):
        read_batch(write_batch(**changed))


def test_the_page_lists_the_names_of_models() -> None:
    page = (Path(__file__).parents[2] / "docs" / "batches.md").read_text()
    rows = [line.strip("| ").split(" | ") for line in page.splitlines() if line.startswith("| ")]
    told = {row[0]: row[1].split(", ") for row in rows if row[0] in GALLERY}
    assert told == {group: list(names) for group, names in GALLERY.items()}

"""The same settings make the same bake from the command line, a job, an operator and the panel."""

from collections.abc import Iterator
from dataclasses import MISSING, replace
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
import rsibr
from rsibr.operators import bake_kinds
from rsibr.rsibr_addon.command_line import bake as bake_command
from rsibr.rsibr_addon.command_line import job as job_command
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.options import Declared, declared_options, to_plain, value_text
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.option_properties import property_name, show_option
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.tasks.queue.bake_request import request_for
from rsibr.tests.bake_jobs import run_job

NEEDED = {"radiance_views": {"material": "clay"}, "lobe_stack": {"brdf": "ward:alpha=0.3,ks=0.5"}}
"""Kind -> settings without which there is nothing to bake."""

TEXTS = {
    "material": "plastic",
    "brdf": "ggx:alpha=0.4,f0=0.5",
    "diffuse": "lambert:kd=0.2",
    "emission": "2/1/0.5",
    "probes": "box:light=fit.json,size=4/4/4",
}
TEXTS |= {"specular": "phong:n=9,ks=0.1", "coat": "fresnel:eta=1.4", "retro": "phong:n=20,ks=0.1"}
TEXTS |= {"refraction": "clear:eta=1.3", "weights": "fresnel:eta=1.4"}
"""A value of each option that is text."""

TOGETHER = {
    "seek": {"method": "greedy"},
    "cosine": {"method": "single"},
    "fit": {"brdf": None},
    "goal": {"more_views": 1},
    "exponents": {"filter": "phong"},
}
"""Option -> others that it cannot be without."""

SMALL: dict[str, dict[str, Any]] = {
    "radiance_views": {"size": 8, "samples": 2},
    "lobe_stack": {"lobes": 1, "slices": 2, "size": 16},
    "reflection_tables": {"material": "plastic", "diffuse_rows": 4, "rows": 16},
    "mip_chain": {"size": 64},
    "kernel_bank": {"size": 64},
    "kernel_pyramid": {"size": 256},
}
"""Kind -> settings that are baked fast, and that the panel offers too."""


def other_value(declared: Declared) -> Any:
    """A value that is not the default."""
    told, default = declared.option, declared.default
    if declared.wanted is bool:
        return not default
    if told.offered:
        return told.offered[0]
    if told.choices:
        return list(told.choices)[-1]
    if declared.wanted is str:
        return TEXTS.get(declared.name, "fit.json")
    if declared.wanted is float:
        return 0.25
    if declared.members is float:
        return (9.0, 4.0)
    return int(told.least) + 1


CASES = [
    pytest.param(kind, {declared.name: other_value(declared)}, id=f"{kind}-{declared.name}")
    for kind, stored in STORED.items()
    for declared in declared_options(stored.settings)
]


@pytest.fixture(autouse=True)
def light(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Light]:
    monkeypatch.chdir(tmp_path)
    gradient = np.linspace(0.1, 2.0, 32 * 64 * 3, dtype=np.float32).reshape(32, 64, 3)
    path = tmp_path / "light.exr"
    write_radiance(path, gradient)
    (tmp_path / "fit.json").touch()
    rsibr.register()
    yield Light(environment=str(path), clamp=1.5)
    rsibr.unregister()


def full_settings(kind: str, changed: dict[str, Any]) -> dict[str, Any]:
    (name,) = changed if len(changed) == 1 else ("",)
    return NEEDED.get(kind, {}) | TOGETHER.get(name, {}) | changed


def by_command_line(kind: str, values: dict[str, Any], light: Light) -> list[str]:
    words = ["bake", kind.replace("_", "-"), "--environment", str(light.environment), "--clamp", "1.5"]
    for declared in declared_options(STORED[kind].settings):
        value = values.get(declared.name)
        if isinstance(value, bool):
            words.append(declared.flag if value else declared.flag.replace("--", "--no-", 1))
        elif value is not None:
            words += [declared.flag, value_text(value)]
    return [*words, "-o", "out.rsibr.exr", "--progress", "none"]


def by_operator(kind: str, values: dict[str, Any], light: Light) -> dict[str, Any]:
    given: dict[str, Any] = {"environment": light.environment, "clamp": light.clamp}
    for declared in declared_options(STORED[kind].settings):
        value = values.get(declared.name, MISSING)
        if value is None or value is MISSING:
            continue
        materials = declared.option.materials
        if materials and not materials.own:
            given["preset"] = value
        else:
            is_text = bool(declared.option.choices) or isinstance(value, tuple)
            given[property_name(declared)] = value_text(value) if is_text else value
    if "preset" not in given and kind == "reflection_tables":
        given["preset"] = "none"
    return given


def in_panel(kind: str, values: dict[str, Any], light: Light) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.picture = kind, "PICTURE", str(light.environment)
    chosen.clamp = light.clamp
    group = getattr(chosen, kind)
    if kind == "reflection_tables":
        group.preset = "none"
    for declared in declared_options(STORED[kind].settings):
        value = values.get(declared.name, MISSING)
        if value is MISSING:
            continue
        materials = declared.option.materials
        if materials is None:
            show_option(declared, group, value)
        elif materials.presets:
            group.preset = value
            if materials.own:
                group.source = "PRESET"
        elif value is None:
            group.source = materials.instead.upper()
        else:
            group.source, group.brdf = "MODEL", value


@pytest.mark.parametrize(("kind", "changed"), CASES)
def test_every_option_goes_every_way(
    kind: str, changed: dict[str, Any], light: Light, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    values = full_settings(kind, changed)
    expected = BakeJob(STORED[kind].settings(**values), "out.rsibr.exr", light)
    (name,) = changed
    value = changed[name]
    assert to_plain(expected.settings)[name] == (list(value) if isinstance(value, tuple) else value)
    jobs = []

    def baked(job: BakeJob[Any], *report: object) -> dict[str, Any]:
        jobs.append(job)
        return {}

    monkeypatch.setattr(bake_command, "run_job", baked)
    monkeypatch.setattr(job_command, "run_job", baked)
    assert run(by_command_line(kind, values, light)) == 0
    assert run_job(expected, tmp_path) == 0
    monkeypatch.setattr(bake_kinds, "bake", baked)
    monkeypatch.setattr("rsibr.operators.stepwise.drain", lambda steps: None)
    monkeypatch.setattr(bake_kinds._BakeKind, "finish", lambda self, result: None)
    operator = getattr(bpy.ops.rsibr, f"bake_{kind}")
    assert operator(filepath="out.rsibr.exr", **by_operator(kind, values, light)) == {"FINISHED"}
    in_panel(kind, values, light)
    request = request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object)
    jobs.append(request.job(Path("out.rsibr.exr")))
    # Commands and operators refuse what exists, jobs keep it
    assert [job.if_missing for job in jobs] == [False, True, False, True]
    assert [replace(job, if_missing=False) for job in jobs] == 4 * [expected]


@pytest.mark.slow
@pytest.mark.needs("cycles")
@pytest.mark.usefixtures("quick_furnace")
@pytest.mark.parametrize("kind", STORED)
def test_every_way_makes_the_same_file(kind: str, light: Light, tmp_path: Path) -> None:
    values, output = NEEDED.get(kind, {}) | SMALL[kind], Path("out.rsibr.exr")
    made = []

    def take() -> None:
        made.append(output.read_bytes())
        output.unlink()

    assert run(by_command_line(kind, values, light)) == 0
    take()
    assert run_job(BakeJob(STORED[kind].settings(**values), str(output), light), tmp_path) == 0
    take()
    operator = getattr(bpy.ops.rsibr, f"bake_{kind}")
    assert operator(filepath=str(output.resolve()), **by_operator(kind, values, light)) == {"FINISHED"}
    take()
    in_panel(kind, values, light)
    assert (
        run_job(
            request_for(bpy.context.scene.rsibr_bake, bpy.context.scene, bpy.context.object).job(output),
            tmp_path,
        )
        == 0
    )
    take()
    assert made == 4 * [made[0]]

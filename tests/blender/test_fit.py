"""`rsibr fit`: the figures, the file, and what bad input says."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from rsibr.operators import fit_lobes as operator
from rsibr.operators.fit_lobes import RSIBR_OT_fit_lobes
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.brdf.lambert import Lambert
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.errors import (
    OutputFileError,
    RangeError,
    RenderError,
    RsibrError,
    RsibrWarning,
    SceneError,
)
from rsibr.rsibr_addon.core.lobes.captures import CapturedFit
from rsibr.rsibr_addon.core.progress import Progress, Steps, drain
from rsibr.rsibr_addon.files.fits import read_fit
from rsibr.rsibr_addon.files.map_set import read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.settings.fit import FitSettings, Fitting
from rsibr.rsibr_addon.tasks.methods.fit_captures import CapturedResult, Captures, read_captures
from rsibr.rsibr_addon.tasks.reflectance import fit_views
from rsibr.rsibr_addon.tasks.reflectance.fit_lobes import fit_lobes
from rsibr.rsibr_addon.tasks.reflectance.model_fits import fit_model
from rsibr.tests.mirror_capture import environment, write_mirror_capture

COMMAND = ["fit", "--brdf", "phong:n=40,ks=0.5", "--slices", "3", "--lobes", "2"]


def test_the_command_writes_a_fit_and_tells_its_figures(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "FIT.json"
    assert run([*COMMAND, "--json", "-o", str(path)]) == 0
    told = json.loads(capfd.readouterr().out.splitlines()[-1])
    assert told["fit"] == str(path)
    assert (told["lobes"], told["slices"], told["taps"]) == (2, 3, 1)
    assert 0.0 < told["E"] < 0.2
    assert told["E_grazing"] is None
    assert told["albedo_error"] < 1e-3
    assert 1.0 < told["amplification"] < 8.0
    assert json.loads(path.read_text())["report"]["E"] == told["E"]
    assert read_fit(path).brdf == "phong:n=40,ks=0.5"
    # People are told what a figure is
    assert run([*COMMAND, "--force", "-o", str(path)]) == 0
    lines = capfd.readouterr().out.splitlines()
    for name in ("E", "albedo_error", "amplification"):
        (line,) = (line for line in lines if line.split()[0] == name)
        assert f" {told[name]:.3g} " in line
        assert len(line.split()) > 4


@pytest.mark.slow
def test_captures_make_a_fit_and_that_a_stack_in_other_light(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    captures, path, stack = (tmp_path / name for name in ("mirror.rsibr.exr", "FIT.json", "stack.rsibr.exr"))
    write_mirror_capture(captures, size=32)
    command = ["fit", "--captures", str(captures), "-o", str(path), "--json"]
    assert run(command) == 0
    told = json.loads(capfd.readouterr().out.splitlines()[-1])
    # Texels of a sphere map are far coarser than a mirror's lobe, but this light has nothing finer
    assert 0.0 < told["left_out"] < 0.05
    fit = read_fit(path)
    assert (fit.brdf, fit.method, fit.left_out) == ("blend:mirror", "captured", told["left_out"])
    write_radiance(tmp_path / "other.exr", environment().radiance[:, ::-1])
    light = ["--environment", str(tmp_path / "other.exr")]
    assert run(["bake", "lobe-stack", *light, "--fit", str(path), "--size", "16", "-o", str(stack)]) == 0
    assert read_map_set_header(stack)["error_bound"]["left_out"] == told["left_out"]
    capfd.readouterr()
    assert run(["info", str(stack)]) == 0
    assert f"Error, left out {told['left_out']:.2g} " in " ".join(capfd.readouterr().out.split())
    # One view alone states no error
    assert run([*command, "--captured-views", "1", "--force"]) == 0
    assert json.loads(capfd.readouterr().out.splitlines()[-1])["left_out"] is None


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "Lobes are fitted to a reflectance model or to captures: give one of them."),
        (["--captures", "a.rsibr.exr", "--brdf", "lambert:kd=1"], "give one of them"),
        (["--captures", "a.rsibr.exr", "--lobes", "2"], "finds its own lobes: leave the options out"),
        (["--brdf", "lambert:kd=1", "--captured-views", "3"], "A model has no captured views"),
        (["--captures", "a.rsibr.exr", "--plot", "p"], "no model to plot beside a fit to captures"),
        (["--captures", "a.rsibr.exr"], "a.rsibr.exr"),
        (["--brdf", "lambert:kd=1", "--goal", "0.1"], "A goal is for fits to captures"),
    ],
)
def test_model_or_captures(
    words: list[str],
    sentence: str,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["fit", *words, "-o", "FIT.json"]) == 1
    assert sentence in capfd.readouterr().err
    assert not (tmp_path / "FIT.json").exists()


@pytest.fixture
def fit_to_goal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A function of a goal and of what a fit to captures states and finds when it asks for the material."""
    captures = tmp_path / "mirror.rsibr.exr"
    write_mirror_capture(captures, size=16)

    def fitted(goal: float, left_out: float | None, material: Any) -> dict[str, Any]:
        def captured(captures: Captures, count: int | None = None) -> Steps[CapturedResult]:
            fit = yield from fit_model(lambert, Fitting(lobes=1, slices=2))
            stated = replace(fit.fit, method="captured", left_out=left_out)
            return CapturedResult(CapturedFit(stated, (), (), None), 0.0)

        lambert = brdf_from_spec("lambert:kd=0.5", lambda name, path: Lambert(kd=0.5))
        monkeypatch.setattr(fit_views, "captured_fit", captured)
        monkeypatch.setattr(fit_views, "load_brdf", material)
        settings = FitSettings(captures=str(captures), goal=goal)
        found = drain(fit_views.fit_views(settings, tmp_path / "FIT.json", force=True))
        assert read_fit(tmp_path / "FIT.json").method == found.fit.method
        return found.report()

    return fitted


def shiny(spec: str) -> Steps[Brdf]:
    """A material that is much like the mirror, as if it were measured."""
    assert spec == "blend:mirror"
    yield Progress(0, 1, "measuring")
    return brdf_from_spec("ggx:alpha=0.2,metal=silver", lambda name, path: Lambert(kd=0.5))


def test_captures_that_reach_the_goal_are_enough(fit_to_goal: Any) -> None:
    assert fit_to_goal(0.1, 0.1, None)["source"] == "captures"


@pytest.mark.slow
@pytest.mark.parametrize("left_out", [0.9, None])
def test_the_material_itself_is_fitted_where_captures_tell_too_little(
    fit_to_goal: Any, left_out: float | None
) -> None:
    told = fit_to_goal(0.5, left_out, shiny)
    # Radiance changes by about as much as the mirror's over the width of the lobe
    assert told["source"] == "material"
    assert 0.0 < told["left_out"] < 0.5


@pytest.mark.slow
def test_the_closer_of_both_is_kept_and_a_missed_goal_told(fit_to_goal: Any) -> None:
    with pytest.warns(RsibrWarning, match="have an error of 0.002 in views left out, and the goal is 0.001"):
        told = fit_to_goal(0.001, 0.002, shiny)
    assert (told["source"], told["left_out"]) == ("captures", 0.002)


@pytest.mark.parametrize("error", [SceneError, RenderError])
def test_captures_serve_where_the_material_cannot_be_had(
    fit_to_goal: Any, monkeypatch: pytest.MonkeyPatch, error: type[RsibrError]
) -> None:
    def not_measured(spec: str) -> Steps[Brdf]:
        yield Progress(0, 1, "measuring")
        raise error("Material mirror only mirrors.")

    with pytest.warns(RsibrWarning) as told:
        assert fit_to_goal(0.001, 0.5, not_measured)["source"] == "captures"
    first, second = (str(each.message) for each in told)
    assert first.endswith("so they are those of the captures: Material mirror only mirrors.")
    assert "the goal is 0.001: capture more views" in second
    # A file that a map set names is not opened
    other = "blend:other.blend:Paint"
    monkeypatch.setattr(fit_views, "read_captures", lambda path: replace(read_captures(path), spec=other))
    with pytest.warns(RsibrWarning) as told:
        assert fit_to_goal(0.001, 0.5, None)["source"] == "captures"
    assert "opened only if you name it: do so with --brdf" in str(told[0].message)


def test_plots_are_written_whole_or_not_at_all(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path, plots = tmp_path / "FIT.json", tmp_path / "plots"
    assert run([*COMMAND, "--method", "single", "--plot", str(plots), "-o", str(path)]) == 0
    assert sorted(plot.name for plot in plots.iterdir()) == [
        "error.svg",
        "lobes-20.svg",
        "lobes-50.svg",
        "lobes-80.svg",
    ]
    assert read_fit(path).method == "single"
    # Somebody's own folder is left alone, and nothing is fitted for it
    assert run([*COMMAND, "--plot", str(tmp_path), "-o", str(tmp_path / "other.json")]) == 1
    assert "holds other things: give the name of a new folder" in capfd.readouterr().err
    assert not (tmp_path / "other.json").exists()


@pytest.mark.parametrize("method", ["greedy", "single-2d"])
def test_every_method_fits(tmp_path: Path, method: str) -> None:
    path = tmp_path / "FIT.json"
    assert run([*COMMAND, "--method", method, "-o", str(path)]) == 0
    assert read_fit(path).method == method


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (["--lobes", "0"], "Lobes cannot be 0: choose 1 to 12."),
        (["--lobes", "99"], "Lobes cannot be 99"),
        (["--slices", "0"], "Elevations cannot be 0: choose 1 to 256"),
        (["--slices", "9999"], "Elevations cannot be 9999"),
        (["--taps", "0"], "Taps cannot be 0: choose 1 to 9."),
        (["--error", "1.5"], "Error cannot be 1.5: choose"),
        (["--brdf", "phong:n=40,ks=2"], "phong: ks"),
        (["--brdf", "merl:path=none.binary"], "none.binary does not exist"),
        (["--brdf", "lambert:kd=0"], "The reflectance is black, NaN or infinite"),
    ],
)
def test_bad_input_is_told_in_a_sentence_and_writes_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], more: list[str], sentence: str
) -> None:
    assert run([*COMMAND, *more, "-o", str(tmp_path / "FIT.json")]) == 1
    assert sentence in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_error_out_of_reach_is_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "FIT.json"
    assert run([*COMMAND, "--error", "0.0001", "-o", str(path)]) == 0
    err = capfd.readouterr().err
    assert "2 lobes for each layer leave an error of 0.0" in err
    assert "not 0.0001: allow more lobes." in err
    assert len(read_fit(path).weights) == 2


def test_existing_fits_are_kept(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "FIT.json"
    path.write_text("kept")
    assert run([*COMMAND, "-o", str(path)]) == 1
    assert "--force to replace it" in capfd.readouterr().err
    assert path.read_text() == "kept"


def test_errors_of_several_fits_are_plotted_beside_each_other(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    single, joint, plots = tmp_path / "single.json", tmp_path / "joint.json", tmp_path / "plots"
    assert run([*COMMAND, "--method", "single", "-o", str(single)]) == 0
    beside = ["--beside", str(single), "-o", str(joint)]
    assert run([*COMMAND, *beside]) == 1
    assert "Fits beside are for the plot of the errors: give --plot" in capfd.readouterr().err
    plotted = [*COMMAND, "--plot", str(plots)]
    assert run([*plotted, "--beside", str(single), "-o", str(tmp_path / "s" / "single.json")]) == 1
    assert "two are single: rename one" in capfd.readouterr().err
    assert run([*plotted, *beside]) == 0
    text = (plots / "error.svg").read_text()
    assert ">joint</text>" in text
    assert ">single</text>" in text
    other = ["fit", "--brdf", "phong:n=9,ks=0.5", "--plot", str(plots), "--force", *beside]
    assert run(other) == 1
    assert "is a fit of phong:n=40,ks=0.5, not of phong:n=9,ks=0.5" in capfd.readouterr().err


def test_a_fit_among_its_plots_is_refused_at_once(tmp_path: Path) -> None:
    plots = tmp_path / "plots"
    plots.mkdir()
    with pytest.raises(OutputFileError, match="which holds nothing but plots: write it elsewhere"):
        next(fit_lobes(FitSettings(brdf="phong:ks=0.5,n=8"), plots / "fit.json", plots=plots))
    assert list(plots.iterdir()) == []


@pytest.mark.usefixtures("registered")
def test_the_operator_writes_what_the_command_writes(tmp_path: Path) -> None:
    path, other = tmp_path / "FIT.json", tmp_path / "other.json"
    spec = "phong:n=40,ks=0.5"
    assert bpy.ops.rsibr.fit_lobes(filepath=str(path), brdf=spec, lobes=2, slices=3) == {"FINISHED"}
    assert run([*COMMAND, "-o", str(other)]) == 0
    np.testing.assert_array_equal(read_fit(path).weights, read_fit(other).weights)
    with pytest.raises(RuntimeError, match="--force to replace it"):
        bpy.ops.rsibr.fit_lobes(filepath=str(path), brdf=spec, lobes=2, slices=3)


@pytest.mark.usefixtures("registered")
@pytest.mark.parametrize("captures", ["", "views.rsibr.exr"])
def test_the_dialog_shows_what_counts_for_what_is_fitted(captures: str) -> None:
    shown: list[str] = []
    column = SimpleNamespace(prop=lambda owner, name: shown.append(name))
    asked = SimpleNamespace(captures=captures, layout=SimpleNamespace(column=lambda: column))
    RSIBR_OT_fit_lobes.draw(asked, bpy.context)
    assert set(shown) <= set(bpy.ops.rsibr.fit_lobes.get_rna_type().properties.keys())
    assert shown[0] == "captures"
    of_captures = {"captured_views", "goal"}
    assert (of_captures <= set(shown), "lobes" in shown) == (bool(captures), not captures)


@pytest.mark.usefixtures("registered")
@pytest.mark.parametrize("asks", [True, False])
@pytest.mark.parametrize(
    ("captures", "changed"),
    [
        ("views.rsibr.exr", {"lobes": 5}),
        ("views.rsibr.exr", {"brdf": "lambert:kd=1"}),
        ("", {"captured_views": 3}),
        ("", {"goal": 0.1}),
    ],
)
def test_the_dialog_forgets_what_it_no_longer_shows(
    captures: str, changed: dict[str, Any], asks: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A script is told of it instead."""
    properties = bpy.ops.rsibr.fit_lobes.get_rna_type().properties
    model = {} if captures else {"brdf": "phong:n=40,ks=0.5"}
    values = {name: each.default for name, each in properties.items() if name != "rna_type"}
    asked = SimpleNamespace(**{**values, **model, "captures": captures, **changed}, _asks=asks)
    given: list[FitSettings] = []
    monkeypatch.setattr(operator, "fit_lobes", lambda settings, *rest: given.append(settings))
    if asks:
        RSIBR_OT_fit_lobes.work(asked, bpy.context)
        assert given == [FitSettings(captures=captures) if captures else FitSettings(**model)]
    else:
        with pytest.raises(RangeError):
            RSIBR_OT_fit_lobes.work(asked, bpy.context)


def test_methods_have_no_use_for_what_is_anothers() -> None:
    with pytest.raises(RangeError, match="are for the method joint, not single"):
        FitSettings(brdf="", method="single", taps=3)
    with pytest.raises(RangeError, match="Fit cannot be 'exact': choose one of joint"):
        FitSettings(brdf="", method="exact")
    with pytest.raises(RangeError, match="is for the method greedy, not joint"):
        FitSettings(brdf="", seek="search")
    with pytest.raises(RangeError, match="choose one of peaks, places, search"):
        FitSettings(brdf="", method="greedy", seek="luck")

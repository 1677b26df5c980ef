"""Captures to which lobes are fitted, and which go on where their views tell least of these."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import MapSetError, RangeError, RsibrWarning
from rsibr.rsibr_addon.core.geometry.geodesic import geodesic_sphere
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.files.fits import read_fit
from rsibr.rsibr_addon.files.kinds.radiance_views import from_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, read_map_set_header
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.files.stated_lobes import stated_lobes
from rsibr.rsibr_addon.job import BakeJob
from rsibr.rsibr_addon.settings.fit import FitSettings
from rsibr.rsibr_addon.settings.light import Light
from rsibr.rsibr_addon.settings.lobe_stack import LobeStackSettings
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.methods import more_views
from rsibr.rsibr_addon.tasks.methods.bake import bake
from rsibr.rsibr_addon.tasks.reflectance import fit_views
from rsibr.rsibr_addon.tasks.reflectance.fit_lobes import fit_lobes

FOUR = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]) / 3.0**0.5


@pytest.fixture
def job(tmp_path: Path) -> Any:
    """A function of more settings: a job of four views."""
    radiance = np.random.default_rng(3).random((16, 32, 3), dtype=np.float32) ** 8
    write_radiance(tmp_path / "light.exr", radiance)
    (tmp_path / "four.txt").write_text("\n".join(" ".join(map(str, row)) for row in FOUR.tolist()))

    def with_settings(**more: Any) -> BakeJob[RadianceViewsSettings]:
        views = {"view_file": str(tmp_path / "four.txt"), "size": 8, "material": "lambert:kd=0.5"}
        settings = RadianceViewsSettings(**{**views, **more})
        return BakeJob(
            settings, str(tmp_path / "more.rsibr.exr"), Light(environment=str(tmp_path / "light.exr"))
        )

    return with_settings


def view_dirs(path: str) -> np.ndarray:
    return from_map_set(Path(path), read_map_set(Path(path), "radiance_views")).sphere.vertices


@pytest.mark.slow
def test_views_are_added_and_lobes_fitted_to_all_state_the_same_error(job: Any, tmp_path: Path) -> None:
    wanted = job(more_views=5)
    baked = drain(bake(wanted))
    views = view_dirs(wanted.output)
    np.testing.assert_allclose(views[:4], FOUR, atol=1e-12)
    # Four of one fit and one of the next, all of the sphere of which there are enough
    np.testing.assert_array_less(
        np.linalg.norm(views[4:, None] - geodesic_sphere(42).vertices, axis=2).min(1), 1e-6
    )
    assert (baked.figures["views"], baked.figures["chosen"]) == (9, 5)
    drain(fit_lobes(FitSettings(captures=wanted.output), tmp_path / "fit.json"))
    again, kept = read_fit(tmp_path / "fit.json"), stated_lobes(wanted.output)
    assert kept.left_out == baked.figures["left_out"]
    # Directions go through the file's decimals
    assert again.left_out == pytest.approx(kept.left_out, rel=1e-6)
    np.testing.assert_allclose(again.weights, kept.weights, rtol=1e-5, atol=1e-6 * np.ptp(kept.weights))


@pytest.mark.slow
def test_an_interrupted_choice_is_kept(job: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = job(more_views=2)
    kept = more_views.KeptViews(Path(f"{wanted.output}.partial"))
    work = bake(wanted)
    while not len(kept.chosen()):
        next(work)
    chosen = kept.chosen()
    work.close()
    monkeypatch.setattr(more_views, "next_views", None)
    drain(bake(wanted))
    np.testing.assert_allclose(view_dirs(wanted.output)[4:], chosen, rtol=0, atol=1e-12)


@pytest.mark.slow
def test_no_view_is_added_once_the_goal_is_reached(job: Any) -> None:
    baked = drain(bake(job(more_views=6, goal=1.0)))
    assert (baked.figures["views"], baked.figures["chosen"]) == (4, 0)
    assert re.fullmatch(
        r"4 views of 8x8, error in views left out 0\.\d+; lobes, error in views left out 0\.0\d+, .*",
        baked.told,
    )


@pytest.mark.slow
def test_lobes_of_a_capture_are_relit(job: Any, tmp_path: Path) -> None:
    wanted = job(fit_lobes=True)
    baked = drain(bake(wanted))
    assert baked.figures["source"] == "captures"
    header = read_map_set_header(wanted.output)
    assert header["error_bound"]["left_out_lobes"] == baked.figures["left_out"]
    stack = BakeJob(
        LobeStackSettings(fit=wanted.output, size=16), str(tmp_path / "stack.rsibr.exr"), wanted.light
    )
    drain(bake(stack))
    relit, kept = stated_lobes(stack.output), stated_lobes(wanted.output)
    # A stack states its profiles to 6 digits, of the kernels that they have
    used = np.isin(kept.bank.kappa, relit.bank.kappa)
    np.testing.assert_allclose(relit.weights, kept.weights[:, :, used], rtol=1e-5)
    assert not kept.weights[:, :, ~used].any()


@pytest.mark.slow
def test_lobes_that_miss_the_goal_give_way_to_those_of_the_material(
    job: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = job(fit_lobes=True, goal=0.001)
    # Enough for a Lambert surface
    monkeypatch.setattr(fit_views, "LOBES", 1)
    with pytest.warns(RsibrWarning, match=r"The lobes have an error of .* and the goal is 0.001"):
        baked = drain(bake(wanted))
    fit = stated_lobes(wanted.output)
    assert (baked.figures["source"], fit.method) == ("material", "joint")
    assert "; lobes of the material itself, error in views left out " in baked.told


def test_views_without_light_are_kept_without_lobes(job: Any) -> None:
    wanted = job(fit_lobes=True, material="lambert:kd=0")
    with pytest.warns(RsibrWarning, match="No lobes are fitted to the views: The captured views are black"):
        drain(bake(wanted))
    assert view_dirs(wanted.output).shape == (4, 3)
    with pytest.raises(MapSetError, match=r"more.rsibr.exr states no lobes: capture with --fit"):
        stated_lobes(wanted.output)


def test_what_cannot_go_on_is_refused() -> None:
    with pytest.raises(RangeError, match="A goal is for lobes fitted to the views: ask for them"):
        RadianceViewsSettings(material="copper", goal=0.1)
    for more in ({"more_views": 2}, {"fit_lobes": True, "goal": 0.1}):
        with pytest.raises(RangeError, match="Photographs are what they are: leave More Views and Goal out"):
            RadianceViewsSettings(material="paint", photographs="balls.json", **more)

"""Qualities of the panel: what they set, and what a bake costs."""

import itertools
from pathlib import Path

import bpy
import pytest
from rsibr.rsibr_addon.core.options import declared_options, quality_values
from rsibr.rsibr_addon.files.kinds.registry import STORED
from rsibr.rsibr_addon.files.map_set import is_whole_map_set, read_map_set_header
from rsibr.rsibr_addon.files.output_paths import HASH_LETTERS
from rsibr.rsibr_addon.host.option_properties import property_name, shown_value
from rsibr.rsibr_addon.host.qualities import has_quality
from rsibr.rsibr_addon.job import read_job
from rsibr.rsibr_addon.settings.radiance_views import RadianceViewsSettings
from rsibr.rsibr_addon.tasks.methods.bake import METHODS
from rsibr.rsibr_addon.tasks.methods.recipe import recipe_hash
from rsibr.tests.bake_jobs import run_job
from rsibr.tests.blender.bake_orders import order, output

pytestmark = pytest.mark.usefixtures("panel")


KINDS = sorted(STORED)

QUALITIES = ("DRAFT", "GOOD", "FINAL")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("quality", QUALITIES)
def test_every_quality_is_what_the_command_takes(kind: str, quality: str) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = kind
    assert bpy.ops.rsibr.apply_quality(quality=quality) == {"FINISHED"}
    settings = getattr(chosen, kind)
    values = quality_values(STORED[kind].settings, quality.lower())
    for declared in declared_options(STORED[kind].settings):
        if declared.name in values:
            assert getattr(settings, property_name(declared)) == shown_value(declared, values[declared.name])
    job = order().job(Path("out.rsibr.exr"))
    assert values.items() <= vars(job.settings).items()
    assert read_job(job.to_json(), "job") == job


def test_a_quality_is_that_of_all_methods_but_those_changed_by_hand() -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.radiance_views.samples = "mip_chain", 33
    bpy.ops.rsibr.apply_quality(quality="FINAL")
    final = {kind: has_quality(STORED[kind].settings, getattr(chosen, kind), "final") for kind in STORED}
    assert final == {kind: kind != "radiance_views" for kind in STORED}
    assert chosen.radiance_views.samples == 33
    chosen.kind = "radiance_views"
    bpy.ops.rsibr.apply_quality(quality="DRAFT")
    assert has_quality(STORED["radiance_views"].settings, chosen.radiance_views, "draft")


@pytest.mark.parametrize("kind", KINDS)
def test_better_costs_more(kind: str) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = kind
    costs = []
    for quality in QUALITIES:
        bpy.ops.rsibr.apply_quality(quality=quality)
        costs.append(order().cost)
    for less, more in itertools.pairwise(costs):
        assert less.processor_seconds < more.processor_seconds
        # More maps of a lobe stack take no more: they are made one after another
        assert less.memory < more.memory or (kind == "lobe_stack" and less.memory == more.memory)
        assert less.disk < more.disk


@pytest.mark.parametrize("kind", KINDS)
def test_a_better_quality_is_never_coarser(kind: str) -> None:
    qualities = [quality_values(STORED[kind].settings, each.lower()) for each in QUALITIES]
    for declared in declared_options(STORED[kind].settings):
        draft, good, final = (each.get(declared.name) for each in qualities)
        if declared.wanted is int and good is None:
            assert final is None  # as much as light and lobe need is not to be had with a number
        elif declared.wanted is int:
            assert draft <= good <= final


@pytest.mark.slow
def test_the_file_is_as_large_as_was_said(tmp_path: Path) -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind, chosen.light, chosen.studio = "mip_chain", "STUDIO", "forest"
    for size in ("64", "256"):
        chosen.mip_chain.size = size
        path = output()
        assert run_job(order().job(path), tmp_path) == 0
        # Said for any light; how well a picture is compressed depends on it
        assert 0.4 < path.stat().st_size / order().cost.disk < 1.6
        assert is_whole_map_set(path)
        # A job given by hand is known by what the panel names its files after
        assert f"-{recipe_hash(read_map_set_header(path)['recipe'])[:HASH_LETTERS]}.rsibr.exr" in path.name


def test_sharper_and_layered_models_cost_more() -> None:
    chosen = bpy.context.scene.rsibr_bake
    chosen.kind = "lobe_stack"
    costs = []
    for spec in ("ggx:alpha=0.3,metal=copper", "ggx:alpha=0.1,metal=copper", "car_paint:name=bmw_339"):
        chosen.lobe_stack.brdf = spec
        costs.append(order().cost)
    for less, more in itertools.pairwise(costs):
        assert less.processor_seconds < more.processor_seconds
        assert less.disk < more.disk


def test_lobes_fitted_to_views_cost_more_and_after_each_few_chosen_views_again() -> None:
    costs = [
        METHODS["radiance_views"].cost(
            RadianceViewsSettings(material="clay", fit_lobes=fitted, more_views=more)
        )
        for fitted, more in ((False, None), (True, None), (True, 4), (True, 8))
    ]
    views, fits, once_more, twice_more = (each.processor_seconds for each in costs)
    assert 10.0 < fits - views < once_more - fits < twice_more - once_more
    for less, more in itertools.pairwise(costs):
        assert less.memory < more.memory

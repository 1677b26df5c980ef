"""What radiance looks like: the table against Blender's own pictures, and no trace of either."""

import bpy
import numpy as np
import pytest
from rsibr.rsibr_addon.core.pictures.display import displayed, table_radiance
from rsibr.rsibr_addon.host.display import display_of, displayed_colours, scale_before_display

VIEWS = ["Standard", "AgX", "Filmic", "Raw", "Khronos PBR Neutral"]


def lit_colours(count: int = 20_000) -> np.ndarray:
    """Radiance over 12 stops, its channels within two of each other, shape (count, 3), float32."""
    rng = np.random.default_rng(1)
    stops = rng.uniform(-8.0, 4.0, (count, 1)) + rng.uniform(-1.0, 1.0, (count, 3))
    return np.exp2(stops).astype(np.float32)


@pytest.mark.parametrize("view", VIEWS)
def test_the_table_is_within_one_step_of_blender_s_own(view: str) -> None:
    scene = bpy.context.scene
    scene.view_settings.view_transform = view
    colours = lit_colours()
    table = displayed_colours(scene, table_radiance())
    error = np.abs(displayed(table, colours) - displayed_colours(scene, colours))
    assert error.max() < 1.0 / 255.0


def test_standard_and_raw_are_known() -> None:
    scene = bpy.context.scene
    grey = np.full((1, 3), 0.18, dtype=np.float32)
    scene.view_settings.view_transform = "Standard"
    # 1.055 * 0.18 ** (1 / 2.4) - 0.055, to 16 bits
    assert displayed_colours(scene, grey) == pytest.approx(0.4613, abs=1e-4)
    scene.view_settings.view_transform = "Raw"
    assert displayed_colours(scene, grey) == pytest.approx(0.18, abs=1e-4)


@pytest.mark.parametrize("curves", [False, True])
def test_exposure_is_in_the_table_or_before_it(curves: bool) -> None:
    scene = bpy.context.scene
    view = scene.view_settings
    view.view_transform, view.exposure, view.use_curve_mapping = "Standard", 1.5, curves
    if curves:
        view.curve_mapping.curves[3].points.new(0.3, 0.5)
        view.curve_mapping.update()
    colours = lit_colours(2000)
    # What Blender makes of it without our taking exposure apart: one picture, saved as a render.
    scene.render.image_settings.color_depth = "16"
    expected = _saved(scene, colours)
    before = display_of(scene)
    found = displayed_colours(scene, scale_before_display(scene) * colours)
    assert display_of(scene) == before
    # Stored to 16 bits, and rounded before the exposure where that is apart.
    np.testing.assert_allclose(found, expected, atol=2e-4)


def test_what_changes_the_look_is_noticed() -> None:
    scene = bpy.context.scene
    view = scene.view_settings
    seen = {display_of(scene)}
    changes = [
        lambda: setattr(view, "view_transform", "Standard"),
        lambda: setattr(view, "look", "High Contrast"),
        lambda: setattr(view, "gamma", 1.2),
        lambda: setattr(view, "use_white_balance", True),
        lambda: setattr(view, "white_balance_tint", 20.0),
        lambda: setattr(view, "use_curve_mapping", True),
        lambda: view.curve_mapping.curves[0].points.new(0.5, 0.6),
        lambda: setattr(view, "exposure", 1.0),
    ]
    for number, change in enumerate(changes, start=2):
        change()
        seen.add(display_of(scene))
        assert len(seen) == number


def test_no_trace_stays() -> None:
    scene = bpy.context.scene
    before = {(type(item).__name__, item.name) for item in bpy.data.all_ids}
    depth, view = scene.render.image_settings.color_depth, scene.view_settings.exposure
    displayed_colours(scene, lit_colours(10))
    assert {(type(item).__name__, item.name) for item in bpy.data.all_ids} == before
    assert (scene.render.image_settings.color_depth, scene.view_settings.exposure) == (depth, view)


def _saved(scene: bpy.types.Scene, colours: np.ndarray) -> np.ndarray:
    import tempfile
    from pathlib import Path

    from rsibr.rsibr_addon.files.photographs import read_photograph

    scene.render.dither_intensity = 0.0
    image = bpy.data.images.new("colours", len(colours), 1, float_buffer=True)
    image.pixels.foreach_set(np.c_[colours, np.ones(len(colours))].astype(np.float32).ravel())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "saved.png"
        image.save_render(str(path), scene=scene)
        return read_photograph(path).encoded()[0]

"""A line in the viewport: previews on one side, Blender's shading or another look on the other."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from rsibr.tests.flat_capture import write_flat_capture

Told = Callable[[str], dict]

SPLIT = """
def scenario(told):
    bare(view())
    bpy.context.scene.view_settings.view_transform = "Standard"
    bpy.data.objects["Cube"].rsibr.map_set = "/job/flat.rsibr.exr"
    yield from drawn()
    whole = like(pixels(), (188, 0, 188))
    part, settings = region(view()), bpy.context.window_manager.rsibr_view
    settings.split, settings.line = True, 0.5
    yield from drawn()
    columns = np.flatnonzero(like(pixels(), (188, 0, 188)).any(axis=0))
    first = np.flatnonzero(whole.any(axis=0))[0]
    told["shown"] = [int(columns[0] - first), int(columns[-1] - part.width // 2)]
    with bpy.context.temp_override(window=window(), area=view(), region=part):
        told["invoked"] = list(bpy.ops.rsibr.drag_split("INVOKE_DEFAULT"))
    yield
    for fraction in (0.3, 0.45):
        x, y = part.x + int(fraction * part.width), part.y + part.height // 2
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        yield
    window().event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    yield
    window().event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
    yield from drawn()
    told["modal"] = len(window().modal_operators)
    told["line"] = settings.line
    columns = np.flatnonzero(like(pixels(), (188, 0, 188)).any(axis=0))
    told["dragged"] = int(columns[-1] - (x - part.x))
    # The other side in another look
    gpu_map_set = next(iter(session().previews._map_sets.used.values())).gpu_map_set
    draw, looks = gpu_map_set.draw, []

    def recorded(mesh, placed, look):
        looks.append(str(look.mode))
        draw(mesh, placed, look)

    gpu_map_set.draw = recorded
    settings.beyond = "other"
    bpy.data.objects["Cube"].rsibr.other.radiance_views.mode = "paper"
    yield from drawn()
    told["looks"] = looks[-2:]
    shown = like(pixels(), (188, 0, 188))
    told["missing"] = int((whole & ~shown).any(axis=0).sum())
    # How far both are apart: not at all, so black, above a scale that ends white
    settings.beyond, settings.compared = "difference", "other"
    yield from drawn()
    picture, line = pixels(), round(settings.line * part.width)
    told["difference"] = int(picture[whole & (np.arange(part.width) > line + 2)].max())
    size = bpy.context.preferences.system.ui_scale
    along = [line + round(size * (24 + share * 192)) for share in (0.01, 1 / 3, 2 / 3, 0.99)]
    told["scale"] = picture[round(size * 30), along].tolist()
    above, right = (slice(*(round(size * each) for each in ends)) for ends in ((40, 56), (10, 230)))
    told["numbers"] = int((picture[above, line:][:, right].min(axis=-1) > 120).sum())
    # How far the preview is from Blender's own shading
    settings.compared, cube = "blender", bpy.data.objects["Cube"]
    for name, green in (("alike", 0.0), ("unlike", 0.5)):
        cube.color = (0.5, green, 0.5, 1.0)
        yield from drawn()
        yield from drawn()
        inside = whole & (np.arange(part.width) > line + 6)
        told[name] = float(np.median(pixels()[inside].max(axis=-1)))
"""


def test_a_line_parts_previews_from_blender_s_shading(told: Told, job: Path) -> None:
    write_flat_capture(job / "flat.rsibr.exr", (0.5, 0.0, 0.5))
    answer = told(SPLIT)
    # The line itself is two pixels wide
    assert answer["shown"][0] == 0
    assert -4 <= answer["shown"][1] <= 0
    assert answer["invoked"] == ["RUNNING_MODAL"]
    assert answer["modal"] == 0
    assert abs(answer["line"] - 0.45) < 2e-3
    assert -4 <= answer["dragged"] <= 0
    assert answer["looks"] == ["fragment", "paper"]
    # Columns of the line, of which each side draws its two
    assert 2 <= answer["missing"] <= 4
    assert answer["difference"] <= 9  # black, as Mesa encodes it
    assert answer["numbers"] > 50
    assert answer["alike"] <= 9
    assert answer["unlike"] > 240
    black, red, yellow, white = np.array(answer["scale"])
    assert black.max() < 30
    np.testing.assert_allclose(red, (255, 0, 0), atol=15)
    np.testing.assert_allclose(yellow, (255, 255, 0), atol=15)
    assert white.min() > 240

"""The Result panel in Blender's window: pictures of maps and lobes, made once, gone with the file."""

from collections.abc import Callable

from rsibr.tests.gui.panel import PRELUDE

PICTURES = """
facts = importlib.import_module(ROOT + ".rsibr_addon.tasks.report.facts")
panels = importlib.import_module(ROOT + ".rsibr_addon.session.map_pictures")

def look():
    # With what timers bring meanwhile
    for _ in range(3):
        yield from drawn()

def shown():
    # What the sidebar shows
    area, region = sidebar()
    part = xshot.grab()[::-1][region.y : region.y + region.height, region.x : region.x + region.width]
    return part.astype(int)

def scenario(told):
    with bpy.context.temp_override(window=window()):
        light = {"filepath": "/job/mips.rsibr.exr", "environment": "sunset"}
        bpy.ops.rsibr.bake_mip_chain(**light, size=64, filter="box")
        bpy.ops.rsibr.bake_lobe_stack(
            filepath="/job/stack.rsibr.exr", environment="city", brdf="ward:alpha=0.3,ks=1", size=16, slices=4
        )
        bpy.ops.rsibr.assign(filepath="/job/mips.rsibr.exr")
    yield from tab()
    bpy.types.RSIBR_PT_result_lobes.bl_options = set()
    only(*(getattr(bpy.types, f"RSIBR_PT_result{part}") for part in ("", "_maps", "_lobes")))
    yield from look()
    yield from done(lambda: session().map_pictures.items)
    told["mips"] = [each[1] for each in session().map_pictures.items]
    yield from look()
    before = shown()
    bpy.context.window_manager.rsibr_result.part = "environment"
    yield from look()
    told["another map"] = bool((abs(shown() - before).max(axis=-1) > 30).sum() > 2000)
    bpy.ops.rsibr.assign(filepath="/job/stack.rsibr.exr")
    yield from look()
    yield from done(lambda: session().map_pictures.items)
    # The environment was the eighth
    told["of another"] = bpy.context.window_manager.rsibr_result.part
    told["stack"] = [each[1] for each in session().map_pictures.items]
    yield from look()
    # From here on nothing is read, however often and whatever is drawn of the same file
    def refuse(*arguments):
        raise AssertionError("a file is read again")
    reading = {name: getattr(where, name) for where, name in READING}
    for where, name in READING:
        setattr(where, name, refuse)
    for angle in (0.1, 0.9):
        before = shown()
        bpy.context.window_manager.rsibr_result.angle = angle
        yield from look()
        told[f"lobes at {angle}"] = bool((abs(shown() - before).max(axis=-1) > 30).sum() > 200)
    for where, name in READING:
        setattr(where, name, reading[name])
    os.remove("/job/stack.rsibr.exr")
    yield from look()
    with bpy.context.temp_override(window=window()):
        bpy.ops.wm.read_homefile(app_template="")
    told["after loading"] = len(session().map_pictures.items)

READING = [(facts, "read_map_set_header"), (panels, "map_set_pictures")]
"""


MU = ("0.12", "0.38", "0.62", "0.88")
"""In the middle of four elevations."""


def test_maps_and_lobes_are_shown_and_read_once(told: Callable[[str], dict]) -> None:
    assert told(PRELUDE + PICTURES) == {
        "mips": [f"Mip {mip}" for mip in range(7)] + ["Environment", "Harmonics"],
        "another map": True,
        "of another": "lobe01.slice003",
        "stack": [
            *(
                f"Lobe {lobe}, Seen at {angle}\N{DEGREE SIGN}"
                for lobe in (1, 2, 3)
                for angle in (83, 68, 51, 29)
            ),
            "Environment",
        ],
        "lobes at 0.1": True,
        "lobes at 0.9": True,
        "after loading": 0,
    }

"""What moves a page: pointers, fingers, keys and sliders; and a page that loses its context."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.tasks.export.page.page import FILL
from rsibr.tests.web.browser import driven
from rsibr.tests.web.test_page import (
    SET_UP,
    SIZE,
    VIEW,
    check_alike,
    light_file,
    page_of,
    preview,
    radiance,
)


@pytest.mark.slow
def test_dragging_and_sliders_change_what_the_preview_would(tmp_path: Path) -> None:
    source = light_file(tmp_path, "kernel_pyramid")
    script = """
    const mouse = (type, x, y) =>
      browser("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1 });
    const hint = document.querySelector("#hint");
    const told = !hint.hidden;
    await mouse("mousePressed", 20, 20);
    const turned = settled();
    await mouse("mouseMoved", 20 + SIZE / 4, 20);
    await mouse("mouseReleased", 20 + SIZE / 4, 20);
    const dragged = (await turned).pixels;
    await set("metallic", 1);
    const changed = (await set("roughness", 0.25)).pixels;
    const lit = (await set("turn", 45)).pixels;
    const fibres = (await set("sheen_weight", 1)).pixels;
    const hints = [told, !hint.hidden];
    answer({ pictures: [dragged, changed, lit, fibres].map(encoded), hints });
    """.replace("SIZE", str(SIZE))
    said = driven(page_of(source), SET_UP + script)
    assert said["hints"] == [True, False]
    # A quarter of the frame's width is an eighth of a turn of the eye, clockwise seen from above
    x, y, z = VIEW
    half = np.sqrt(0.5)
    view = (half * (x + y), half * (y - x), z)
    dragged, changed, lit, fibres = map(radiance, said["pictures"])
    check_alike(dragged, preview(source, view=view))
    metal = PrincipledLook(metallic=1.0, roughness=0.25)
    check_alike(changed, preview(source, metal, view))
    # Light that turns with the eye looks as before; turned alone by as much, as an eye that turned back
    turned_eye = (half * (view[0] + view[1]), half * (view[1] - view[0]), z)
    check_alike(lit, preview(source, metal, turned_eye))
    check_alike(fibres, preview(source, replace(metal, sheen_weight=1.0), turned_eye))


def widths(said: dict[str, str]) -> dict[str, int]:
    """How many pixels wide the object is in each picture."""
    return {name: int((radiance(text)[..., 3] > 0.5).any(axis=0).sum()) for name, text in said.items()}


@pytest.mark.slow
def test_fingers_and_keys_orbit_and_magnify(tmp_path: Path) -> None:
    script = """
    const fingers = async (type, ...at) =>
      browser("Input.dispatchTouchEvent", { type, touchPoints: at.map(([x, y], id) => ({ x, y, id })) });
    await browser("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 2 });
    const after = async (act) => {
      const next = settled();
      await act();
      return encoded((await next).pixels);
    };
    const key = (named) => after(async () => {
      await browser("Input.dispatchKeyEvent", { type: "keyDown", key: named });
      await browser("Input.dispatchKeyEvent", { type: "keyUp", key: named });
    });
    canvas.focus();
    const small = [];
    for (let time = 0; time < 8; time++) small.push(await key("-"));
    const away = small[small.length - 1];
    const pinched = await after(async () => {
      await fingers("touchStart", [38, 48], [58, 48]);
      await fingers("touchMove", [28, 48], [68, 48]); // from 20 pixels apart to 40
      await fingers("touchEnd");
    });
    const scale = visualViewport.scale;
    const right = await key("ArrowRight");
    const left = await key("ArrowLeft");
    answer({ widths: { first: encoded(first.pixels), away, pinched }, right, left, pinched, scale });
    """
    said = driven(page_of(light_file(tmp_path, "mip_chain")), SET_UP + script)
    seen = widths(said["widths"])
    assert 0.88 * SIZE < seen["first"] < 0.95 * SIZE  # with air around it
    assert abs(seen["away"] - FILL * SIZE / 1.1**8) <= 2
    assert abs(seen["pinched"] - min(2 * FILL * SIZE / 1.1**8, SIZE)) <= 2
    assert said["scale"] == 1, "the browser itself magnified the page"
    assert not np.allclose(radiance(said["right"]), radiance(said["pinched"]), atol=1e-2)
    assert np.allclose(radiance(said["left"]), radiance(said["pinched"]), atol=1e-4)


@pytest.mark.slow
def test_a_page_goes_on_after_its_context_was_lost(tmp_path: Path) -> None:
    script = """
    await set("roughness", 0.8);
    const before = await set("turn", 90);
    const lose = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
    lose.loseContext();
    await new Promise((done) => setTimeout(done, 100));
    const again = settled();
    lose.restoreContext();
    const after = await again;
    const told = !document.querySelector("#trouble").hidden;
    answer({ before: encoded(before.pixels), after: encoded(after.pixels), told });
    """
    source = light_file(tmp_path, "mip_chain")
    said = driven(page_of(source), SET_UP + script, before="window.expectsTrouble = true;")
    assert not said["told"]
    assert np.array_equal(radiance(said["before"]), radiance(said["after"]))

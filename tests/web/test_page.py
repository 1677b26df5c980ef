"""A map set's web page, opened from disk in a browser: what it draws is what `rsibr preview` draws."""

import base64
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rsibr.rsibr_addon.command_line.main import run
from rsibr.rsibr_addon.core.geometry.directions import turn_about_z
from rsibr.rsibr_addon.core.kinds.kernel_bank.shading import BankLook
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.look import PrincipledLook
from rsibr.rsibr_addon.core.kinds.kernel_pyramid.split_sum import split_families
from rsibr.rsibr_addon.core.kinds.mip_chain.shading import MipLook
from rsibr.rsibr_addon.core.pictures.display import displayed, table_radiance
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.suns import NO_SUNS
from rsibr.rsibr_addon.device.kinds.kernel_pyramid import GpuPyramid
from rsibr.rsibr_addon.device.preview import STILL, PreviewRenderer
from rsibr.rsibr_addon.files.kinds.kernel_pyramid import shipped_families
from rsibr.rsibr_addon.files.kinds.registry import look_types
from rsibr.rsibr_addon.files.map_set import write_map_set
from rsibr.rsibr_addon.files.radiance_pictures import write_radiance
from rsibr.rsibr_addon.host.display import displayed_colours
from rsibr.rsibr_addon.host.meshes import TriangleMesh, load_mesh
from rsibr.rsibr_addon.host.scenes import temporary_scene
from rsibr.rsibr_addon.settings.matte import LIGHT
from rsibr.rsibr_addon.settings.page import PageOptions
from rsibr.rsibr_addon.tasks import matte
from rsibr.rsibr_addon.tasks.export.page import matte as page_matte
from rsibr.rsibr_addon.tasks.export.page.page import FILL, export_page
from rsibr.rsibr_addon.tasks.methods.kinds import open_map_set
from rsibr.tests.engine_light import sky, sky_file
from rsibr.tests.mirror_capture import mirror_map_set
from rsibr.tests.web.browser import SWIFTSHADER, driven

SIZE = 96
VIEW = (0.3, -1.0, 0.4)
SETTINGS = PageOptions(view=VIEW, perspective=40.0)

LIGHT_ALONE = ("mip-chain", "--filter", "ggx", "--size", "64")
BAKES = {
    "mip_chain": LIGHT_ALONE,
    "lobe_stack": ("lobe-stack", "--brdf", "ggx:alpha=0.4,metal=copper", "--slices", "3", "--size", "64"),
    "reflection_tables": ("reflection-tables", "--material", "varnished"),
    "kernel_bank": ("kernel-bank", "--size", "64"),
    "kernel_pyramid": ("kernel-pyramid", "--size", "64"),
}
"""Kind -> what bakes it."""

LOOKS = {"kernel_bank": BankLook(brdf="ggx:alpha=0.4,metal=copper")}
"""Kind -> what is shown of it, where that is not the default."""

SET_UP = f"""
const canvas = document.querySelector("canvas");
const drawn = () => new Promise((done) => {{
  canvas.addEventListener("drawn", ({{ detail }}) => done(detail()), {{ once: true }});
}});
const settled = async () => {{
  let read;
  do {{ read = await drawn(); }} while (read.width !== {SIZE} || read.height !== {SIZE});
  return read;
}};
const encoded = (values) => {{
  let text = "";
  for (const byte of new Uint8Array(values.buffer)) text += String.fromCharCode(byte);
  return btoa(text);
}};
const set = async (name, value) => {{
  const control = document.querySelector(`[name="${{name}}"]`);
  control[control.type === "checkbox" ? "checked" : "value"] = value;
  const after = settled();
  control.dispatchEvent(new Event(control.tagName === "SELECT" ? "change" : "input"));
  return after;
}};
canvas.style.cssText = "flex: none; width: {SIZE}px; height: {SIZE}px";
const first = await settled();
"""
"""The first picture, and what moves a control and waits for the next."""

KEPT = """
const getContext = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, options) {
  return getContext.call(this, kind, { ...options, preserveDrawingBuffer: true });
};
"""
"""Has a canvas keep what it shows."""


def light_file(folder: Path, kind: str) -> Path:
    """A small map set of a kind, or a picture."""
    picture = sky_file(folder)
    if kind == "environment":
        return picture
    path = folder / f"{kind}.rsibr.exr"
    if kind in BAKES:
        bake = ["bake", *BAKES[kind][:1], "--environment", str(picture), *BAKES[kind][1:], "-o", str(path)]
        assert run(bake) == 0
    else:
        write_map_set(path, mirror_map_set(size=64))
    return path


def page_of(source: Path, look: Any = None, mesh: TriangleMesh | None = None) -> Path:
    made = export_page(source, source.with_name("page.html"), SETTINGS, mesh or load_mesh("sphere"), look)
    (page,) = drain(made)
    return page


def radiance(said: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(said), "<f4").reshape(SIZE, SIZE, 4)


def preview(
    source: Path,
    look: Any = None,
    view: tuple[float, float, float] = VIEW,
    mesh: TriangleMesh | None = None,
) -> np.ndarray:
    opened, mesh = open_map_set(source), mesh or load_mesh("sphere")
    renderer = PreviewRenderer(opened.drawable())
    shown = look or look_types()[opened.kind]()
    surface = FILL * mesh.positions, mesh.normals, mesh.triangles
    return renderer.draw(*surface, SETTINGS.camera(view), SIZE, shown)


def check_alike(got: np.ndarray, wanted: np.ndarray) -> None:
    """The same but for rounding: of texels by 1e-3 at most."""
    covered = np.abs(got[..., 3] - wanted[..., 3])
    assert covered.max() <= 4 / 16  # an edge may run along four of sixteen samples
    assert np.quantile(covered, 0.999) <= 1.01 / 16
    inside = wanted[..., 3] == 1.0
    error, size = (got - wanted)[inside], wanted[inside][:, :3]
    assert np.sqrt(np.mean(error**2)) < 1e-3 * np.sqrt(np.mean(size**2))


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*BAKES, "radiance_views", "environment"])
def test_a_page_of_every_kind_is_the_preview(kind: str, tmp_path: Path) -> None:
    source = light_file(tmp_path, kind)
    look, mesh = LOOKS.get(kind), load_mesh("monkey" if kind == "kernel_pyramid" else "sphere")
    said = driven(page_of(source, look, mesh), SET_UP + "answer({pixels: encoded(first.pixels)});")
    check_alike(radiance(said["pixels"]), preview(source, look, mesh=mesh))


MATTES = {
    "light": {"background": LIGHT, "background_blur": 8.0, "background_exposure": -1.0, "floor": True},
    "picture": {"background": "picture.exr", "background_exposure": 1.0, "floor": True},
    "floor": {"floor": True},
}
"""What lies behind the objects."""


@pytest.mark.slow
@pytest.mark.parametrize("behind", MATTES)
def test_what_lies_behind_is_that_of_the_preview(
    behind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (matte, page_matte):
        monkeypatch.setattr(module, "LAMPS", 16)
        monkeypatch.setattr(module, "SHADOW_SIZE", 128)
    chosen = dict(MATTES[behind])
    if behind == "picture":
        chosen["background"] = str(tmp_path / "picture.exr")
        write_radiance(Path(chosen["background"]), sky(150)[:, 40:240])  # wider than high, in no whole pixels
    settings = PageOptions(view=VIEW, perspective=40.0, **chosen)
    source, mesh, look = light_file(tmp_path, "mip_chain"), load_mesh("sphere"), MipLook(roughness=0.3)
    (page,) = drain(export_page(source, tmp_path / "page.html", settings, mesh, look))
    script = 'answer({first: encoded(first.pixels), lit: encoded((await set("turn", 60)).pixels)});'
    said = driven(page, SET_UP + script)
    opened = open_map_set(source)
    renderer, positions = PreviewRenderer(opened.drawable()), FILL * mesh.positions
    studio = matte.Matte(settings, opened.environment, positions, mesh.triangles)
    for name, degrees in (("first", 0.0), ("lit", 60.0)):
        camera, turns = settings.camera(VIEW), (STILL, turn_about_z(np.radians(degrees)))
        alone = renderer.draw(positions, mesh.normals, mesh.triangles, camera, SIZE, look, *turns)
        wanted, got = studio.under(alone, camera, *turns), radiance(said[name])
        assert np.abs(wanted - alone).max() > 0.1
        assert np.sqrt(np.mean((got - wanted) ** 2)) < 1e-3 * np.sqrt(np.mean(wanted**2))


@pytest.mark.slow
def test_a_driver_with_a_coarse_grid_shows_the_same(tmp_path: Path) -> None:
    """SwiftShader moves corners by up to 1/32 of a sample; mirrored lamps of a texel show that."""
    source = tmp_path / "lamps.exr"
    radiance_of_lamps = np.full((16, 32, 3), 0.1, np.float32)
    radiance_of_lamps[tuple(np.random.default_rng(4).integers(0, (16, 32), (20, 2)).T)] = 50.0
    write_radiance(source, radiance_of_lamps)
    said = driven(page_of(source), SET_UP + "answer({pixels: encoded(first.pixels)});", driver=SWIFTSHADER)
    check_alike(radiance(said["pixels"]), preview(source))


@pytest.mark.slow
def test_normals_of_a_mesh_are_those_of_the_preview(tmp_path: Path) -> None:
    """Of a sphere that is shaded as an ellipsoid: none is its position."""
    source, sphere, look = light_file(tmp_path, "mip_chain"), load_mesh("sphere"), MipLook(roughness=0.3)
    normals = sphere.normals * np.array([1.0, 3.0, 0.5], np.float32)
    mesh = replace(sphere, normals=normals / np.linalg.norm(normals, axis=1, keepdims=True))
    said = driven(page_of(source, look, mesh), SET_UP + "answer({pixels: encoded(first.pixels)});")
    check_alike(radiance(said["pixels"]), preview(source, look, mesh=mesh))


@pytest.mark.slow
def test_a_kernel_banks_page_has_sliders_of_its_material(tmp_path: Path) -> None:
    """They take lobes of the families, as a pyramid of the bank's light does; a model's text has a fit."""
    source = light_file(tmp_path, "kernel_bank")
    page = page_of(source)
    assert "This page has its maps as they are." in page.read_text(encoding="utf-8")
    said = driven(page, SET_UP + 'answer({pixels: encoded((await set("metallic", 1)).pixels)});')
    pyramid = tmp_path / "pyramid.rsibr.exr"
    light = ("--environment", str(tmp_path / "sky.exr"), "--size", "512")
    assert run(["bake", "kernel-pyramid", *light, "-o", str(pyramid)]) == 0
    check_alike(radiance(said["pixels"]), preview(pyramid, PrincipledLook(metallic=1.0)))


@pytest.mark.slow
def test_the_split_sum_stands_beside(tmp_path: Path) -> None:
    """In light with a sun, which GGX itself reflects on one side and the split sum's lobe on the other."""
    light, source = sky(), tmp_path / "light.rsibr.exr"
    light[90, 100] = 2000.0, 1800.0, 1500.0
    write_radiance(tmp_path / "sun.exr", light)
    bake = ["bake", *BAKES["kernel_pyramid"], "--environment", str(tmp_path / "sun.exr"), "-o", str(source)]
    assert run(bake) == 0
    script = """
    await set("metallic", 1);
    await set("beside", true);
    const both = await set("roughness", 0.7);
    const labels = [...document.querySelectorAll("#sides span")].map((side) => side.textContent);
    answer({ pixels: encoded(both.pixels), labels, hidden: document.querySelector("#sides").hidden });
    """
    said = driven(page_of(source), SET_UP + script)
    assert (said["labels"], said["hidden"]) == (["RSIBR", "Split sum"], False)
    pixels, half, metal = radiance(said["pixels"]), SIZE // 2, PrincipledLook(metallic=1.0, roughness=0.7)
    opened, mesh = open_map_set(source), load_mesh("sphere")
    surface = FILL * mesh.positions, mesh.normals, mesh.triangles
    rows = slice(SIZE // 4, SIZE // 4 + half)  # of a square within each half
    assert len(opened.content.suns) == 1
    sunless = replace(opened.content, suns=NO_SUNS)
    for columns, light, families in (
        (slice(0, half), opened.content, shipped_families()),
        (slice(half, SIZE), sunless, split_families(shipped_families())),
    ):
        renderer = PreviewRenderer(GpuPyramid(light, families))
        wanted = renderer.draw(*surface, SETTINGS.camera(VIEW), half, metal)
        check_alike(pixels[rows, columns], wanted)


@pytest.mark.slow
def test_a_page_shows_radiance_as_blender_does(tmp_path: Path) -> None:
    source = light_file(tmp_path, "mip_chain")
    script = """
    const shown = {};
    for (const name of ["Standard", "AgX"]) {
      const menu = document.querySelector("[name=display]");
      menu.value = name;
      menu.dispatchEvent(new Event("change"));
      document.querySelector("[name=exposure]").value = -1;
      document.querySelector("[name=exposure]").dispatchEvent(new Event("input"));
      await new Promise((done) => setTimeout(done, 2000)); // unpacking says nothing of its end
      const { width, height } = canvas;
      const bytes = new Uint8Array(4 * width * height);
      const gl = canvas.getContext("webgl2");
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      shown[name] = encoded(bytes);
    }
    answer({ pixels: encoded(first.pixels), shown });
    """
    said = driven(page_of(source), SET_UP + script, before=KEPT)
    linear = radiance(said["pixels"])
    inside = linear[..., 3] == 1.0
    for name, pixels in said["shown"].items():
        with temporary_scene() as scene:
            scene.display_settings.display_device = "sRGB"
            scene.view_settings.view_transform = name
            table = displayed_colours(scene, table_radiance())
        bytes_ = np.frombuffer(base64.b64decode(pixels), np.uint8).reshape(SIZE, SIZE, 4)
        wanted = displayed(table, 0.5 * linear[inside][:, :3])
        assert np.abs(bytes_[inside][:, :3] / 255.0 - wanted).max() < 1.01 / 255


@pytest.mark.slow
@pytest.mark.parametrize(
    ("before", "sentence"),
    [
        ("HTMLCanvasElement.prototype.getContext = () => null;", "needs WebGL 2"),
        ("WebGL2RenderingContext.prototype.getExtension = () => null;", "draws to float textures"),
        ("delete window.DecompressionStream;", "needs a browser of 2023"),
    ],
)
def test_a_page_says_what_a_browser_lacks(before: str, sentence: str, tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match=sentence):
        driven(page_of(sky_file(tmp_path)), "", before=before)


@pytest.mark.slow
def test_a_damaged_page_says_so(tmp_path: Path) -> None:
    page = page_of(light_file(tmp_path, "mip_chain"))
    text = page.read_text()
    middle = text.index('"data":"', text.index('"atlas"')) + 2000
    page.write_text(text[:middle] + text[middle + 1000 :])
    with pytest.raises(AssertionError, match="This page is damaged: a part of it cannot be unpacked"):
        driven(page, "")

"""What `bench_viewport.py` measures, within Blender's window."""

import functools
import importlib
import time
import types
from collections.abc import Callable, Iterator
from typing import Any

import bpy
import gpu
import in_window
import numpy as np
from in_window import ROOT, drawn, region, run, session, view, window
from mathutils import Quaternion

in_window.SECONDS = 1500.0

FRAMES = 8
REDRAWS = 5
DRAWS = ("draw", "draw_range")
ALLOCATED = ("GPUTexture", "GPUUniformBuf", "GPUFrameBuffer", "GPUBatch", "GPUVertBuf", "GPUIndexBuf")
KINDS = ("mips", "tables", "stack", "pyramid", "views")
MODES = ("paper", "texel", "fragment")

stage = importlib.import_module(f"{ROOT}.rsibr_addon.device.preview_stage")


def wait_for_gpu() -> None:
    """Return when all that was drawn is there."""
    gpu.state.active_framebuffer_get().read_color(0, 0, 1, 1, 4, 0, "UBYTE")


class Device:
    """Counts what is made on the GPU, and how long the driver draws in the thread that asks [s]."""

    def __init__(self) -> None:
        self.allocations = 0
        self.draws = 0.0
        for name in ALLOCATED:
            setattr(gpu.types, name, functools.partial(self._made, getattr(gpu.types, name)))

    def _made(self, kind: Callable[..., Any], *arguments: Any, **named: Any) -> Any:
        self.allocations += 1
        made = kind(*arguments, **named)
        if not hasattr(made, "draw"):
            return made
        timed = {name: functools.partial(self._draw, getattr(made, name)) for name in DRAWS}
        return types.SimpleNamespace(**timed)

    def _draw(self, draw: Callable[..., None], *given: Any, **named: Any) -> None:
        start = time.thread_time()
        draw(*given, **named)
        self.draws += time.thread_time() - start


class Meter:
    """Measures the previews' part of each frame."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._draw = session().previews.draw
        self.cpu: list[float] = []
        self.python: list[float] = []
        self.synchronous = True
        session().previews.draw = self._measured

    def _measured(self, seen: Any) -> bool:
        if self.synchronous:
            wait_for_gpu()
        cpu, python = time.process_time(), time.thread_time() - self._device.draws
        shown: bool = self._draw(seen)
        self.python.append(1e3 * (time.thread_time() - self._device.draws - python))
        if self.synchronous:
            wait_for_gpu()
            self.cpu.append(1e3 * (time.process_time() - cpu))
        return shown

    def frames(self, synchronous: bool) -> Iterator[None]:
        """Orbit for some frames, and measure them alone."""
        self.cpu.clear()
        self.python.clear()
        self.synchronous = synchronous
        orbited = view().spaces.active.region_3d
        while len(self.python) < FRAMES:
            count = len(self.python)
            orbited.view_rotation = orbited.view_rotation @ Quaternion((0.0, 1.0, 0.0), 0.02)
            view().tag_redraw()
            while len(self.python) == count:
                yield


def redraws() -> Iterator[float]:
    """CPU time of redraws of the viewport by Blender, each in another view [ms]."""
    orbited = view().spaces.active.region_3d
    with bpy.context.temp_override(window=window(), area=view(), region=region(view())):
        for _ in range(REDRAWS):
            orbited.view_rotation = orbited.view_rotation @ Quaternion((0.0, 1.0, 0.0), 0.02)
            start = time.process_time()
            # The swap waits for the GPU
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
            yield 1e3 * (time.process_time() - start)


def sphere() -> bpy.types.Object:
    """A smooth sphere of 101,760 triangles that fills the viewport."""
    for item in list(bpy.data.objects):
        bpy.data.objects.remove(item)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=320, ring_count=160)
    bpy.context.object.data.shade_smooth()
    view().spaces.active.region_3d.view_distance = 4.0
    return bpy.context.object


def flat(gpu_map_set: Any) -> None:
    """Have a map set draw meshes without any shading."""
    gpu_map_set.draw = lambda mesh, placed, look: stage.draw_occluder(mesh, placed)


def scenario(told: dict[str, Any]) -> Iterator[None]:
    """Measure everything, one after the other."""
    device = Device()
    item, meter = sphere(), Meter(device)

    def measure(name: str) -> Iterator[None]:
        yield from drawn()
        yield from meter.frames(synchronous=True)
        cpu = float(np.median(meter.cpu))
        before = device.allocations
        yield from meter.frames(synchronous=False)
        python, made = float(np.median(meter.python)), device.allocations - before
        told[name] = {"cpu": cpu, "python": python, "allocations": made}
        assert not session().previews.faults.message(item), session().previews.faults.message(item)

    for kind in KINDS:
        item.rsibr.map_set = f"/job/{kind}.rsibr.exr"
        if kind != "views":
            yield from measure(kind)
            continue
        for mode in MODES:
            item.rsibr.radiance_views.mode = mode
            yield from measure(f"views {mode}")
    flat(session().previews._map_sets.used["/job/views.rsibr.exr"].gpu_map_set)
    yield from measure("flat")

    def switched(kind: str, told: dict[str, Any]) -> Iterator[None]:
        """Choose a map set; tells what took the window's thread longest, and when it was shown [ms]."""
        meter.python.clear()
        start, thread = time.perf_counter(), time.thread_time()
        item.rsibr.map_set = f"/job/{kind}.rsibr.exr"
        chosen = 1e3 * (time.thread_time() - thread)
        yield
        while session().previews.kind(item) is None:
            yield
        told[kind] = [max(chosen, *meter.python), 1e3 * (time.perf_counter() - start)]
        yield from drawn()

    told["switch"] = {}
    session().previews.reload()
    yield from drawn()
    meter.synchronous = True
    for kind in KINDS:  # Once more, now that the programs are built
        yield from switched(kind, told["switch"])
    told["back"] = {}
    yield from switched("stack", told["back"])
    item.rsibr.map_set = ""
    yield from drawn()
    told["solid"] = float(np.median(list(redraws())))
    view().spaces.active.shading.type = "MATERIAL"
    yield from drawn()
    list(redraws())  # EEVEE builds its shaders
    told["eevee"] = float(np.median(list(redraws())))


run(scenario)

"""Previews in Blender's own viewport, among the surfaces that it has drawn.

Previews are drawn into a picture of radiance and depth first. One pass over the screen then brings them to
the display and tests each pixel's depth against Blender's. So every kind of map set uses its own programs,
and only visible pixels are brought to the display.

Blender draws surfaces into one frame buffer and its overlays into another, with the outlines of what is
selected and the 3D cursor, and lays this over that. What previews cover in full goes into the first one.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import blf
import gpu
import numpy as np

from ..core.conventions import Array
from .drawing import LEAST_STRENGTH, Draw, GpuMesh
from .passes import screen_triangle
from .screen_scale import ui_scale
from .stage_shaders import composite_shader, occluder_shader

SCALE_PLACE, SCALE_SIZE = (24, 24), (192, 12)
"""The scale of differences: its corner beside the line, and its size, as the shader has them, in pixels at
Blender's own scale."""

_FONT, _LETTERS = 0, 12.0

_BELOW_ONE = float(np.nextafter(np.float32(1.0), np.float32(0.0)))
"""Coverage that is less than full."""


@dataclass(frozen=True)
class Sight:
    """A view that is drawn.

    Attributes
    ----------
    view, projection : ndarray, shape (4, 4)
    eye : ndarray, shape (4,)
        As in `Draw`.
    """

    view: Array
    projection: Array
    eye: Array

    @classmethod
    def by(cls, view: Array, projection: Array) -> "Sight":
        """The view of matrices, each of shape (4, 4): camera from world, and clip space from camera."""
        return cls.of_pose(view, projection, np.linalg.inv(view))

    @classmethod
    def of_pose(cls, view: Array, projection: Array, pose: Array) -> "Sight":
        """The view of the same matrices where the inverse of the first, `pose`, is known."""
        # The camera's origin, or the direction from which a parallel projection's rays come
        return cls(view, projection, pose[:, 3] if projection[3, 3] == 0.0 else pose[:, 2])

    def on(self, model: Array, turn: Array, strength: float = 1.0) -> Draw:
        """A mesh in this view.

        Parameters
        ----------
        model : ndarray, shape (4, 4)
            World from object coordinates.
        turn : ndarray, shape (3, 3)
        strength : float
            Of the world's light; raised to `LEAST_STRENGTH`.
        """
        return Draw(model, self.view, self.projection, self.eye, turn, max(strength, LEAST_STRENGTH))


def current_sight() -> Sight:
    """The view that Blender is drawing now."""
    view, projection = gpu.matrix.get_model_view_matrix(), gpu.matrix.get_projection_matrix()
    # numpy's inverse takes .1 ms, where the processor has forgotten its code since the last redraw
    return Sight.of_pose(np.array(view), np.array(projection), np.array(view.inverted()))


def active_target() -> gpu.types.GPUFrameBuffer:
    """The frame buffer that is drawn into now."""
    return gpu.state.active_framebuffer_get()


def draw_occluder(mesh: GpuMesh, draw: Draw) -> None:
    """Draw a surface that may hide previews."""
    shader = occluder_shader()
    shader.bind()
    mesh.draw(shader, draw)


@dataclass(frozen=True)
class Difference:
    """What a stage is compared with: the largest of the channels' differences on the display, as heat.

    Attributes
    ----------
    radiance : GPUTexture
        Of the view's pixels.
    scale : float
        Factor of that radiance.
    full : float
        Difference that is white, as a share of the display's range.
    """

    radiance: gpu.types.GPUTexture
    scale: float
    full: float


@dataclass(frozen=True)
class Beneath:
    """Where Blender draws surfaces, beneath its overlays.

    Attributes
    ----------
    target : GPUFrameBuffer
        The one that is active before Blender draws the view.
    scale : float, optional
        Factor of the radiance that it holds, which Blender brings to the display. Without, it holds the
        display's colours, which Blender encodes as sRGB.
    """

    target: gpu.types.GPUFrameBuffer
    scale: float | None


def draw_scale_numbers(left: float, full: float) -> None:
    """Write the numbers of a difference's scale above it, which `viewport_composite_frag.glsl` draws.

    Parameters
    ----------
    left : float
        Where the difference begins, from 0 to 1 of the viewport's width.
    full : float
        See `Difference`.
    """
    _, _, width, _ = gpu.state.viewport_get()
    scale = ui_scale()
    blf.size(_FONT, scale * _LETTERS)
    blf.color(_FONT, 1.0, 1.0, 1.0, 1.0)
    for share in (0.0, 0.5, 1.0):
        text = f"{100.0 * share * full:.3g}%"
        x = left * width + scale * (SCALE_PLACE[0] + share * SCALE_SIZE[0])
        y = scale * (SCALE_PLACE[1] + SCALE_SIZE[1] + 6)
        blf.position(_FONT, x - 0.5 * blf.dimensions(_FONT, text)[0], y, 0.0)
        blf.draw(_FONT, text)


class Stage:
    """The target of previews before they are shown; kept from frame to frame, for all viewports."""

    def __init__(self) -> None:
        self._size = (0, 0)

    @contextmanager
    def drawing(self) -> Iterator[None]:
        """Within, meshes are drawn into the stage, at the view's pixels; it is empty at first."""
        x, y, width, height = gpu.state.active_framebuffer_get().viewport_get()
        self._fit(x + width, y + height)
        with self._target.bind():
            self._target.viewport_set(x, y, width, height)
            self._target.clear(color=(0.0, 0.0, 0.0, 0.0), depth=1.0)
            with _depth_test("LESS_EQUAL"):
                yield

    def show(
        self,
        display: gpu.types.GPUTexture,
        scale: float,
        span: tuple[float, float],
        among_others: bool,
        difference: Difference | None = None,
        beneath: Beneath | None = None,
    ) -> None:
        """Show the stage in the active frame buffer, over what is there where its coverage is below 1.

        Parameters
        ----------
        display : GPUTexture
            A display's colours, see `core.pictures.display`, from `buffers.table_texture`.
        scale : float
            Factor of radiance.
        span : (float, float)
            The part of the width that is shown, from 0 to 1; lines mark its begin and end.
        among_others : bool
            Whether the frame buffer holds the depths of other surfaces.
        difference : Difference, optional
            Shows a difference instead, with a scale.
        beneath : Beneath, optional
            Takes what is covered in full, if no difference is shown.
        """
        compared = difference or Difference(self.radiance, scale, 0.0)
        viewport = gpu.state.active_framebuffer_get().viewport_get()
        shader = self._composite(display, span, compared, viewport)
        with _depth_test("LESS_EQUAL" if among_others else "ALWAYS", "ALPHA"):
            if beneath is None or difference is not None:
                self._cover(shader, scale, (0.0, 1.0))
                return
            with beneath.target.bind():
                beneath.target.viewport_set(*viewport)
                self._cover(shader, beneath.scale or scale, (1.0, 1.0), beneath.scale is not None)
            self._cover(shader, scale, (0.0, _BELOW_ONE))

    def _composite(
        self,
        display: gpu.types.GPUTexture,
        span: tuple[float, float],
        compared: Difference,
        viewport: tuple[int, int, int, int],
    ) -> gpu.types.GPUShader:
        """The program that shows the stage, with all that it needs but what `_cover` says."""
        shader = composite_shader()
        shader.bind()
        x, _, width, _ = viewport
        left, right = span
        shader.uniform_float("left", x + left * width if left > 0.0 else -np.inf)
        shader.uniform_float("right", x + right * width if right < 1.0 else np.inf)
        shader.uniform_sampler("previews", self.radiance)
        shader.uniform_sampler("depths", self._depth)
        shader.uniform_float("ui_scale", ui_scale())
        shader.uniform_float("full", compared.full)
        shader.uniform_float("others_scale", compared.scale)
        shader.uniform_sampler("display", display)
        shader.uniform_sampler("others", compared.radiance)
        return shader

    def _cover(
        self,
        shader: gpu.types.GPUShader,
        scale: float,
        coverage: tuple[float, float],
        as_radiance: bool = False,
    ) -> None:
        """Draw the stage's pixels whose coverage is in a range; and lines, if it holds more than 1."""
        least, most = coverage
        shader.uniform_float("scale", scale)
        shader.uniform_float("least", least)
        shader.uniform_float("most", most)
        shader.uniform_float("line", ui_scale() if least < 1.0 else 0.0)
        shader.uniform_float("as_radiance", float(as_radiance))
        self._screen.draw(shader)

    def depths(self) -> Array:
        """The window's depths of what was drawn last, at the active frame buffer's pixels; 1 for nothing.

        Returns
        -------
        ndarray, shape (height, width), float32
        """
        x, y, width, height = gpu.state.active_framebuffer_get().viewport_get()
        return np.array(self._target.read_depth(x, y, width, height), np.float32)

    def _fit(self, width: int, height: int) -> None:
        """Grow for a viewport that is larger than those before."""
        if width <= self._size[0] and height <= self._size[1]:
            return
        size = (max(width, self._size[0]), max(height, self._size[1]))
        self.radiance = gpu.types.GPUTexture(size, format="RGBA32F")
        self._depth = gpu.types.GPUTexture(size, format="DEPTH_COMPONENT32F")
        self._target = gpu.types.GPUFrameBuffer(depth_slot=self._depth, color_slots=(self.radiance,))
        self._screen = screen_triangle(composite_shader())
        self._size = size  # last, so that a failure above is tried again


@contextmanager
def _depth_test(test: str, blending: str = "NONE") -> Iterator[None]:
    depth_test, depth_mask = gpu.state.depth_test_get(), gpu.state.depth_mask_get()
    blend = gpu.state.blend_get()
    try:
        gpu.state.depth_test_set(test)
        gpu.state.depth_mask_set(True)
        gpu.state.blend_set(blending)
        yield
    finally:
        gpu.state.depth_test_set(depth_test)
        gpu.state.depth_mask_set(depth_mask)
        gpu.state.blend_set(blend)

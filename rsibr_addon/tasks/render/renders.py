"""What renders keep from frame to frame: previews of their own, as they have a thread of their own."""

from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

from ...core.at_once import AtOnce
from ...core.errors import RenderError
from ...device.drawing import GpuMapSet
from ...device.preview_stage import Sight
from ...host.render_views import CameraView
from ..methods.kinds import darkness
from ..methods.live_materials import LiveFits
from ..viewport.frame import Frame
from ..viewport.previews import Previews
from .picture import Picture


class Renders:
    """From the first frame of a render to the end of the last.

    Attributes
    ----------
    trouble : str
        Why a world could not be baked before the render, in a sentence.
    """

    def __init__(self) -> None:
        self.release()

    def release(self) -> None:
        """Let go of everything: a render has ended."""
        self.trouble = ""
        self._previews = Previews(LiveFits(), AtOnce())
        self._darkness: GpuMapSet | None = None
        self._told: set[str] = set()

    def wish(self, inputs: Iterable[tuple[Any, Path]]) -> None:
        """Have objects show files of baked inputs."""
        for item, path in inputs:
            self._previews.inputs.wish(item, path)

    def show_as(self, viewports: Previews) -> None:
        """Have objects show the baked inputs that viewports show."""
        self._previews.inputs.show_as(viewports.inputs)

    def picture(self, view: CameraView, passes: Collection[str]) -> Picture:
        """Make everything ready to draw a frame.

        Parameters
        ----------
        view : CameraView
        passes : collection of str
            See `Picture`.

        Raises
        ------
        RenderError
            The frame cannot be drawn at all.
        """
        previews = self._previews
        previews.data_replaced()  # a render evaluates its own copies, others for each frame
        if not previews.worlds.of(view.scene):
            unbaked = f"The world of {view.scene.name} has not been baked: render again."
            raise RenderError(self.trouble or previews.worlds.message or unbaked)
        frame = self._frame(view)
        while previews.is_busy:
            frame = self._frame(view)
        if trouble := previews.faults.trouble or previews.behind.backgrounds.message:
            raise RenderError(trouble)
        if self._darkness is None:
            self._darkness = darkness()
        return Picture(frame, view, passes, self._darkness)

    def messages(self, picture: Picture) -> list[str]:
        """What is to be said of what a picture shows, as far as it is drawn."""
        told = [message for item in picture.items for message in self._messages(item)]
        return [*told, *self._previews.behind.floors.messages]

    def news(self, messages: Iterable[str]) -> list[str]:
        """Those of some messages that this render has not told."""
        news = list(dict.fromkeys(each for each in messages if each not in self._told))
        self._told.update(news)
        return news

    def _frame(self, view: CameraView) -> Frame:
        with self._previews.faults.guarded():
            return self._previews.frame(view, Sight.by(*view.matrices))
        return Frame([], [], [], [], None, 1.0, self._previews.faults)

    def _messages(self, item: Any) -> list[str]:
        live = item.rsibr.show and item.rsibr.live.on
        told = [f"{item.name} is in live light, which is for viewports: the world lights it here."]
        return [*(told if live else ()), *self._previews.messages(item)]

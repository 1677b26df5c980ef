"""What lies behind all objects of a scene: the world, the world blurred, or a picture."""

from concurrent.futures import Executor, Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...core.environment import Environment
from ...core.errors import RsibrError
from ...core.light.blur import blurred
from ...device.backdrop import Backdrop, Behind, PictureBackdrop
from ...host.option_properties import options_of
from ...settings.render import RenderOptions
from ..light.light_pictures import read_light
from .map_sets import Stamp, stamp_of


@dataclass
class _OfScene:
    """A scene's background.

    Attributes
    ----------
    wanted : tuple
        Tells what it is to be.
    coming : Future
    shown : Behind or None
        What it was last.
    is_told : bool
        Whether it has come, and has been drawn or told of.
    """

    wanted: tuple[Any, ...]
    coming: Future[Behind]
    shown: Behind | None
    is_told: bool = False


class Backgrounds:
    """The backgrounds of scenes that are not the world as it is; made aside.

    Parameters
    ----------
    worker : Executor
        Reads pictures, and blurs light.

    Attributes
    ----------
    message : str
        Why the background that was asked for last cannot be shown, in a sentence; empty if it can.
    """

    def __init__(self, worker: Executor) -> None:
        self._worker, self._scenes = worker, dict[int, _OfScene]()
        self._stamps: dict[Path, Stamp | None] = {}
        self.message = ""

    def files_changed(self) -> None:
        """Look anew whether pictures are still the same."""
        self._stamps.clear()

    @property
    def is_busy(self) -> bool:
        """Whether a background is on its way."""
        return not all(each.is_told for each in self._scenes.values())

    def take_news(self) -> bool:
        """Whether a redraw would show more than the last one."""
        news = [each for each in self._scenes.values() if each.coming.done() and not each.is_told]
        for each in news:
            each.is_told = True
        return bool(news)

    def of(self, scene: Any, world: Backdrop | None) -> tuple[Behind | None, float]:
        """A scene's background: while another is being made, the one before it.

        Parameters
        ----------
        scene : bpy.types.Scene
            Evaluated.
        world : Backdrop or None
            The world's own.

        Returns
        -------
        Behind or None
        exposure : float
            Factor of its radiance.
        """
        self.message = ""
        options, number = options_of(RenderOptions, scene.rsibr_render), scene.session_uid
        exposure = 2.0**options.background_exposure
        if options.background is not None:
            path = Path(options.background)
            if path not in self._stamps:
                self._stamps[path] = stamp_of(path)
            return self._made(number, (path, self._stamps[path]), world, _picture, path), exposure
        if options.background_blur and world:
            blur, light = options.background_blur, world.environment
            return self._made(number, (light.sha256, blur), world, _blurred, light, blur), exposure
        self._scenes.pop(number, None)
        return world, exposure

    def _made(
        self, number: int, wanted: tuple[Any, ...], world: Backdrop | None, make: Any, *given: Any
    ) -> Behind | None:
        known = self._scenes.get(number)
        if known is None or known.wanted != wanted:
            shown = known.shown if known else world
            known = self._scenes[number] = _OfScene(wanted, self._worker.submit(make, *given), shown)
        if known.coming.done():
            known.is_told = True
            try:
                known.shown = known.coming.result()
            except (RsibrError, OSError) as error:
                self.message, known.shown = str(error), world
        return known.shown


def _picture(path: Path) -> Behind:
    return PictureBackdrop(read_light(path))


def _blurred(light: Environment, degrees: float) -> Behind:
    return Backdrop(Environment(blurred(light.radiance, degrees), light.name))

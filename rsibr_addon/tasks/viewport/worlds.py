"""The worlds' own map sets: what surfaces without one of their own are shaded from, where all are shaded."""

from pathlib import Path
from typing import Any

from ...core.errors import RsibrError
from ...files.map_set import is_whole_map_set
from ..queue.world_bakes import world_file
from .map_sets import DARKNESS


class Worlds:
    """Files of worlds, each looked for once until it may have changed.

    Attributes
    ----------
    is_unasked : bool
        Whether a world has no file as it is now.
    message : str
        Why a world cannot have any, in a sentence; empty if all can.
    """

    def __init__(self) -> None:
        self.is_unasked, self.message = False, ""
        self._wanted: dict[tuple[int, int], Path] = {}
        self._shown: dict[int, str] = {}

    def changed(self) -> None:
        """Look anew when a world is shown next."""
        self._wanted.clear()

    @property
    def shown(self) -> set[str]:
        """The files that are shown."""
        return {DARKNESS, *self._shown.values()}

    def of(self, scene: Any) -> str:
        """The file of a scene's world: while another is being baked, the one before it.

        Returns
        -------
        str
            `DARKNESS` where the scene has no world; empty where there is no file yet.
        """
        if scene.world is None:
            return DARKNESS
        world = scene.session_uid, scene.world.session_uid
        if world not in self._wanted:
            self._look(scene, world)
        return self._shown.get(scene.session_uid, "")

    def _look(self, scene: Any, world: tuple[int, int]) -> None:
        self.message = ""
        try:
            path = self._wanted[world] = world_file(scene)
        except (RsibrError, OSError) as error:
            self.message = str(error)
            return
        if str(path) == self._shown.get(scene.session_uid):
            return
        if is_whole_map_set(path):
            self._shown[scene.session_uid] = str(path)
        else:
            self.is_unasked = True

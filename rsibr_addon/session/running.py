"""What the extension keeps in memory, from when it is registered until it leaves."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager

from ..tasks.methods.latest_request_worker import LatestRequestWorker
from ..tasks.methods.live_materials import LiveFits
from ..tasks.queue.background import BakeQueue
from ..tasks.queue.bake_request import ObjectBake
from ..tasks.queue.freshness import Freshness
from ..tasks.render.renders import Renders
from ..tasks.viewport.previews import Previews
from .map_pictures import MapPictures
from .material_notes import MaterialNotes
from .material_pictures import MaterialPictures

READERS = 2
"""Map sets that are read at once, so that one on a slow disk does not keep all others waiting."""


class Session:
    """All of it.

    Parameters
    ----------
    has_windows : bool
        Whether there are panels to show pictures in.

    Attributes
    ----------
    bakes : BakeQueue
        What is baked in the background.
    worker : LatestRequestWorker
        Makes what viewports request.
    previews : Previews
        In viewports.
    renders : Renders
        What renders keep from frame to frame.
    map_pictures : MapPictures
        In panels.
    material_notes : MaterialNotes
    material_pictures : MaterialPictures
        In panels.
    freshness : Freshness
        Of what objects are shaded from.
    """

    def __init__(self, has_windows: bool) -> None:
        with ExitStack() as undo:
            self.material_notes, self.freshness = MaterialNotes(), Freshness()
            self.bakes = BakeQueue[ObjectBake]()
            undo.callback(self._end_bakes)
            self.worker = LatestRequestWorker()
            undo.callback(self.worker.close)
            self._reader = ThreadPoolExecutor(READERS, "rsibr-map-sets")
            undo.callback(self._reader.shutdown, cancel_futures=True)
            self.previews = Previews(LiveFits(self.worker), self._reader)
            undo.callback(self.previews.release)
            self.renders = Renders()
            undo.callback(self.renders.release)
            self.map_pictures = MapPictures(has_windows)
            undo.callback(self.map_pictures.close)
            self.material_pictures = MaterialPictures(has_windows)
            undo.callback(self.material_pictures.close)
            self._undo = undo.pop_all()

    def close(self) -> None:
        """End what goes on, and let go of everything."""
        self._undo.close()

    def _end_bakes(self) -> None:
        bakes = list(self.bakes.bakes)
        self.bakes.close()
        for bake in bakes:
            bake.tidy()


_running: list[Session] = []
"""Blender makes operators and panels itself, and so they have to ask for the session: the last one here."""


@contextmanager
def begun_session(has_windows: bool) -> Iterator[Session]:
    """Within, `session` is one that begins here, and is closed at the end."""
    begun = Session(has_windows)
    _running.append(begun)
    try:
        yield begun
    finally:
        _running.remove(begun)
        begun.close()


def session() -> Session:
    """The session that runs."""
    return _running[-1]

"""The baked inputs that viewports show: read aside, uploaded piece by piece; old ones stay until then."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...core.conventions import Array
from ...core.errors import RsibrError
from ...core.half_floats import half_holds
from ...core.materials.packing import Picture
from ...core.materials.principled import Texture
from ...device.textures import GpuTexture
from ...files.baked_inputs import is_whole, read_baked_inputs, textures_of, unwrapping_name
from .map_sets import PIECE_BYTES

Unwrapping = tuple[str, Array]
"""A UV map's name, and the places of all corners, shape (C, 2)."""


@dataclass(frozen=True, eq=False)
class ShownInputs:
    """Baked inputs of an object.

    Attributes
    ----------
    of_slots : mapping of int to sequence of (Picture, Texture)
        Slot -> what its pictures hold.
    images : mapping of Texture to GpuTexture
    unwrapping : Unwrapping or None
        Where the pictures lie, if that is no UV map of the object.
    remarks : tuple of str
        What an artist should know of them.
    """

    of_slots: Mapping[int, Sequence[tuple[Picture, Texture]]]
    images: Mapping[Texture, GpuTexture]
    unwrapping: Unwrapping | None = None
    remarks: tuple[str, ...] = ()


NOTHING = ShownInputs({}, {})
OF_ANOTHER_MESH = ShownInputs({}, {})
"""Nothing, as the pictures lie on a mesh of other corners."""
NONE = (None, NOTHING)


def read_shown_inputs(path: Path) -> ShownInputs:
    """Read a file, all of which but the upload is done then; in any thread.

    Raises
    ------
    InputFileError, RangeError
        As `read_baked_inputs`.
    """
    baked = read_baked_inputs(path)
    of_slots = textures_of(path, baked)
    images = {}
    for slot, textures in of_slots.items():
        for picture, texture in textures:
            texels = np.pad(baked.pictures[slot, picture], ((0, 0), (0, 0), (0, 1)), constant_values=1.0)
            name = f"bake of {' and '.join(picture)}"
            images[texture] = GpuTexture(name, texels, "RGBA16F" if half_holds([texels]) else "RGBA32F")
    unwrapping = None if baked.corners is None else (unwrapping_name(path), baked.corners)
    return ShownInputs(of_slots, images, unwrapping, baked.remarks)


@dataclass
class _Wish:
    """What an object should show.

    Attributes
    ----------
    path : Path or None
        The file that it needs as it is now; None where it needs none, or that is not known.
    trouble : str
        Why there will be none, in a sentence.
    is_coming : bool
        Whether it was asked of a background Blender.
    """

    path: Path | None = None
    trouble: str = ""
    is_coming: bool = False


@dataclass
class InputBakes:
    """Baked inputs, by object.

    Attributes
    ----------
    reader : Executor
        Reads files: see `read_shown_inputs`.
    is_unasked : bool
        Whether an object may need another file than it was said to.
    """

    reader: Executor
    is_unasked: bool = False
    _wishes: dict[int, _Wish] = field(default_factory=dict)
    _shown: dict[int, tuple[Path, ShownInputs]] = field(default_factory=dict)
    _coming: dict[Path, Future[ShownInputs]] = field(default_factory=dict)
    _has_new: bool = False
    _has_come: bool = False

    @property
    def is_busy(self) -> bool:
        """Whether a file is on its way, so that `take_news` is to be asked."""
        return bool(self._coming)

    def take_news(self) -> bool:
        """Whether a redraw, or its panel, would show more than the last one."""
        has_come, self._has_come = self._has_come, False
        return has_come or any(each.done() for each in self._coming.values())

    def need(self, item: Any) -> None:
        """Say that inputs of an object have to be baked: which is asked of it soon, if it was not."""
        self.is_unasked |= item.session_uid not in self._wishes

    def shown(self, item: Any, corners: int) -> ShownInputs:
        """What an object shows: the newest file that is whole, or `OF_ANOTHER_MESH`."""
        _, inputs = self._shown.get(item.session_uid, NONE)
        if inputs.unwrapping is not None and len(inputs.unwrapping[1]) != corners:
            return OF_ANOTHER_MESH
        return inputs

    def shows_all(self, item: Any) -> bool:
        """Whether an object's bake is there, and is what it needs, by what is known."""
        return item.session_uid in self._shown and not self.lacks(item)

    def wish(self, item: Any, path: Path | None) -> bool:
        """Have an object show a file; it is read if it is there.

        Returns
        -------
        bool
            Whether it is there, or not needed. A file that could not be had is not: see `forgive`.
        """
        number = item.session_uid
        wish = self._wishes.get(number)
        if path is None:
            self._wishes[number] = _Wish()
            self._shown.pop(number, None)
            return True
        if wish is None or wish.path != path:
            wish = self._wishes[number] = _Wish(path)
        if wish.trouble:
            return False
        if path in self._coming:
            return True
        for shown in list(self._shown.values()):  # a copy of the object may show it
            if shown[0] == path:
                self._has_new |= self._shown.get(number) != shown
                self._shown[number] = shown
                return True
        if not is_whole(path):
            return False
        self._coming[path] = self.reader.submit(read_shown_inputs, path)
        return True

    def show_as(self, other: "InputBakes") -> None:
        """Have all objects show what they show elsewhere, or will once a file that is there has been read."""
        self._wishes, self._shown = dict(other._wishes), dict(other._shown)
        shown = {path for path, _ in self._shown.values()}
        for wish in self._wishes.values():
            path = None if wish.trouble or wish.path in shown else wish.path
            if path and path not in self._coming and is_whole(path):
                self._coming[path] = self.reader.submit(read_shown_inputs, path)

    def ask(self, item: Any) -> None:
        """Say that what an object wishes was asked of a background Blender."""
        self._wishes[item.session_uid].is_coming = True

    def refuse(self, item: Any, trouble: str) -> None:
        """Say why an object will have no bake as it is now; what it shows stays."""
        wish = self._wishes.setdefault(item.session_uid, _Wish())
        wish.trouble = trouble

    def forgive(self, item: Any) -> None:
        """Forget why an object had no bake: it is asked for again."""
        self._wishes.pop(item.session_uid, None)

    def is_refused(self, item: Any) -> bool:
        """Whether the bake that an object needs cannot be had."""
        wish = self._wishes.get(item.session_uid)
        return wish is not None and bool(wish.trouble)

    def ended(self, path: Path, trouble: str) -> None:
        """A bake has ended; where it failed, `trouble` says why."""
        for wish in self._wishes.values():
            if trouble and wish.path == path:
                wish.trouble = trouble
        self.is_unasked = True

    def upload(self) -> bool:
        """Upload a piece of what was read.

        Returns
        -------
        bool
            Whether an object shows something new from now on.
        """
        left, changed, self._has_new = PIECE_BYTES, self._has_new, False
        for path, read in list(self._coming.items()):
            if not read.done():
                continue
            try:
                inputs = read.result()
                for image in inputs.images.values():
                    if left > 0:
                        left -= image.upload(left)
            except (RsibrError, OSError) as error:
                self._come(path)
                self.ended(path, str(error))
                continue
            if all(image.is_whole for image in inputs.images.values()):
                self._come(path)
                users = [number for number, wish in self._wishes.items() if wish.path == path]
                self._shown.update(dict.fromkeys(users, (path, inputs)))
                changed |= bool(users)
        return changed

    def _come(self, path: Path) -> None:
        del self._coming[path]
        self._has_come = True

    def lacks(self, item: Any) -> bool:
        """Whether an object does not show what it needs as it is now, by what is known."""
        wish, (path, _) = self._wishes.get(item.session_uid, _Wish()), self._shown.get(item.session_uid, NONE)
        return bool(wish.trouble) or (wish.path is not None and wish.path != path)

    def messages(self, item: Any, by_itself: bool) -> list[str]:
        """What an artist should know of an object's baked inputs.

        Parameters
        ----------
        item : bpy.types.Object
        by_itself : bool
            Whether what is missing is asked for by itself.
        """
        wish, shown = self._wishes.get(item.session_uid, _Wish()), self._shown.get(item.session_uid)
        remarks = list(shown[1].remarks) if shown else []
        if wish.trouble:
            return [wish.trouble, *remarks]
        if not self.lacks(item):
            return remarks
        what = "Material changed" if shown else "Materials need a bake"
        return [
            f"{what}: baking." if by_itself or wish.is_coming else f"{what}: press Bake Materials.",
            *remarks,
        ]

    def keep(self, items: set[int]) -> None:
        """Forget all objects but these."""
        self._wishes = {number: wish for number, wish in self._wishes.items() if number in items}
        self._shown = {number: shown for number, shown in self._shown.items() if number in items}

"""Scenes: the artist's, and temporary ones of our own."""

import contextlib
from collections.abc import Iterator

import bpy

from ..core.errors import SceneError
from ..core.near_names import did_you_mean


def find_scene(name: str | None) -> bpy.types.Scene:
    """A scene of the open file.

    Parameters
    ----------
    name : str or None
        None for the one that the artist works in.

    Raises
    ------
    SceneError
        There is none of that name.
    """
    if name is None:
        return bpy.context.scene
    if name not in bpy.data.scenes:
        names = [scene.name for scene in bpy.data.scenes]
        near = did_you_mean(name, names)
        raise SceneError(f"This file holds no scene {name}{near}: choose one of {', '.join(names)}.")
    return bpy.data.scenes[name]


def find_object(name: str) -> bpy.types.Object:
    """An object of the open file.

    Raises
    ------
    SceneError
        There is none of that name.
    """
    found = bpy.data.objects.get(name)
    if found is None:
        near = did_you_mean(name, [item.name for item in bpy.data.objects])
        raise SceneError(f"This file holds no object {name}{near}: check the name.")
    return found


@contextlib.contextmanager
def temporary_scene() -> Iterator[bpy.types.Scene]:
    """Work in a new, empty scene; afterwards the file is as it was, also when something is raised.

    Yields
    ------
    bpy.types.Scene
        Not shown in any window, at the frame of the artist's scene. Everything that the body adds to the file
        is removed after it: the scene's content, but also materials, images, appended data and the render
        result.

    Notes
    -----
    Whatever appears meanwhile counts as ours, so the body must not give up control by a ``yield`` of a task.
    Handlers (``bpy.app.handlers``) are suspended, so that an artist's own, for example at each render, do not
    see our scene.
    """
    with _temporary_data():
        artists, scene = bpy.context.scene, bpy.data.scenes.new("RSIBR")
        scene.frame_current, scene.frame_subframe = artists.frame_current, artists.frame_subframe
        yield scene


@contextlib.contextmanager
def temporary_copy(scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    """Work in a copy of a scene; afterwards the file is as it was, as by `temporary_scene`.

    Yields
    ------
    bpy.types.Scene
        A scene with its own settings, but the same objects and collections: changes of those are changes for
        the artist.
    """
    with _temporary_data():
        yield scene.copy()


@contextlib.contextmanager
def _temporary_data() -> Iterator[None]:
    """Within, the artist's handlers are suspended; whatever was added to the file is removed afterwards."""
    with _resting_handlers():
        before = {item.session_uid for item in bpy.data.all_ids}
        try:
            yield
        finally:
            bpy.data.batch_remove([item for item in bpy.data.all_ids if item.session_uid not in before])


@contextlib.contextmanager
def _resting_handlers() -> Iterator[None]:
    named = (getattr(bpy.app.handlers, name) for name in dir(bpy.app.handlers))
    handlers = [functions for functions in named if isinstance(functions, list)]
    resting = [functions.copy() for functions in handlers]
    for functions in handlers:
        functions.clear()
    try:
        yield
    finally:
        for functions, rested in zip(handlers, resting, strict=True):
            functions[:] = rested


def evaluated(scene: bpy.types.Scene) -> bpy.types.Depsgraph:
    """What a scene's modifiers, drivers and keys make of it, as viewports show it."""
    with worked_in(scene):
        depsgraph: bpy.types.Depsgraph = bpy.context.evaluated_depsgraph_get()
        return depsgraph


@contextlib.contextmanager
def worked_in(scene: bpy.types.Scene) -> Iterator[None]:
    """Within, a scene is the one that the artist works in."""
    with bpy.context.temp_override(scene=scene):
        yield

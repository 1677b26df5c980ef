"""Lamps that light chosen objects only: an object's stand-in must be chosen as the object is."""

import bpy


def take_place_of(subject: bpy.types.Object, item: bpy.types.Object, lamps: list[bpy.types.Object]) -> None:
    """Let lamps light one object as they light another.

    Parameters
    ----------
    subject : bpy.types.Object
    item : bpy.types.Object
        Its stand-in.
    lamps : list of bpy.types.Object
        Lamps whose collections of receivers, if any, are changed.
    """
    for lamp in lamps:
        receivers = lamp.light_linking.receiver_collection
        state = receivers and _state(receivers, subject)
        if state:
            receivers.objects.link(item)
            entry = receivers.collection_objects[list(receivers.objects).index(item)]
            entry.light_linking.link_state = state


def _state(receivers: bpy.types.Collection, subject: bpy.types.Object) -> str | None:
    """INCLUDE or EXCLUDE, or None for an object that is not named."""
    named = [
        *zip(({item} for item in receivers.objects), receivers.collection_objects, strict=True),
        *zip(
            (set(child.all_objects) for child in receivers.children),
            receivers.collection_children,
            strict=True,
        ),
    ]
    return next((entry.light_linking.link_state for items, entry in named if subject in items), None)

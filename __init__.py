"""RSIBR Reflection Maps: author, bake and preview prefiltered reflection maps in Blender."""


def register() -> None:
    """Register every class, handler and command of the extension with Blender."""
    from .rsibr_addon import registration

    registration.register()


def unregister() -> None:
    """Undo `register`, leaving nothing of the extension in the session."""
    from .rsibr_addon import registration

    registration.unregister()

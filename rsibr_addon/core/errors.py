"""The errors and the warning of the project.

Every message is one sentence that names the thing and the remedy. Interfaces (command line,
operators) turn `RsibrError` and `OSError` into a report; anything else is a bug and keeps its
traceback.
"""


class RsibrError(Exception):
    """Something that a user can put right; the message says what and how."""


class RangeError(RsibrError):
    """A parameter lies outside the range that its function states."""


class ShapeError(RsibrError):
    """An array does not have the shape that its function states."""


class SchemaError(RsibrError):
    """A text is no JSON, or a value is not what its schema demands.

    The message is a phrase, as "parts[2].size is missing": whoever read the file makes a sentence of it.
    """


class InputFileError(RsibrError):
    """A file to be read is missing, unreadable or does not hold what it should."""


class MapSetError(InputFileError):
    """A map set file is truncated, inconsistent, of another kind or of a newer version."""


class OutputFileError(RsibrError):
    """A file cannot be written, or exists and was not to be replaced."""


class NotNowError(OutputFileError):
    """A file cannot be written now, but perhaps later: its disk is full, or does not answer."""


class MemoryShortageError(RangeError):
    """Work takes more memory than is left now: a smaller size fits, or the same one at another time."""


class SceneError(RsibrError):
    """Something in the Blender file (scene, world, material, mesh) cannot be used."""


class RenderError(RsibrError):
    """Cycles did not deliver the picture that was asked for."""


class FarmError(RsibrError):
    """What manages a farm refuses, or is none."""


class DeviceError(RsibrError):
    """The graphics device is missing, or refuses a shader or a texture."""


class RsibrWarning(UserWarning):
    """Work went on, but the user should know something; one sentence, like an error."""

"""What someone may have meant by a name that is not known."""

import difflib
from collections.abc import Iterable


def did_you_mean(name: object, known: Iterable[object]) -> str:
    """A part of a sentence, to follow the unknown name.

    Parameters
    ----------
    name : object
        A name, or what is shown as one.
    known : iterable of object
        The known ones.

    Returns
    -------
    str
        " (did you mean NAME?)", or empty if none is like it.
    """
    near = difflib.get_close_matches(str(name), map(str, known), n=1)
    return f" (did you mean {near[0]}?)" if near else ""

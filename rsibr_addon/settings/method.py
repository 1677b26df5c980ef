"""Base of all methods' settings."""

from typing import ClassVar

from ..core.options import Options


class MethodSettings(Options):
    """Base of the settings of the methods that make map sets.

    Attributes
    ----------
    KIND : str
        Kind of the map sets that the method makes.
    LABEL, SUMMARY : str
        The method in a menu, and what it is for, as a phrase without a full stop.
    REMARK : str
        What to know where there is no material to choose; else empty.
    """

    KIND: ClassVar[str]
    LABEL: ClassVar[str]
    SUMMARY: ClassVar[str]
    REMARK: ClassVar[str] = ""

    @property
    def expected(self) -> str:
        """What errors were measured with such settings, in words; empty where none were."""
        return ""

    @property
    def only_names_material(self) -> bool:
        """Whether the material is no more than a name, as where photographs show it."""
        return False

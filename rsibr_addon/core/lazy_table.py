"""Tables whose rows are imported when they are asked for: a command starts with those that it needs."""

from collections.abc import Iterable, Iterator, MutableMapping
from importlib import import_module
from typing import TypeVar

Row = TypeVar("Row")


class LazyTable(MutableMapping[str, Row]):
    """Name -> row, where the module of each name holds its row.

    Parameters
    ----------
    package : str
        The modules' package, ``__package__`` of whoever has the table.
    attribute : str
        What each module calls its row.
    names : iterable of str
        The modules, in the order of the table.
    """

    def __init__(self, package: str, attribute: str, names: Iterable[str]) -> None:
        self._package, self._attribute = package, attribute
        self._rows: dict[str, Row | None] = dict.fromkeys(names)

    def __getitem__(self, name: str) -> Row:
        row = self._rows[name]
        if row is None:
            row = self._rows[name] = getattr(import_module(f"{self._package}.{name}"), self._attribute)
        return row

    def __setitem__(self, name: str, row: Row) -> None:
        self._rows[name] = row

    def __delitem__(self, name: str) -> None:
        del self._rows[name]

    def __contains__(self, name: object) -> bool:
        return name in self._rows

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

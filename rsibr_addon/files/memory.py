"""The memory that is left, whether work fits into it, and what becomes of freed memory."""

import math
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from ..core.errors import MemoryShortageError

ROOT = Path("/")
"""Root of the file system in which Linux describes itself."""

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3
"""Parameters of glibc's mallopt: how much freed memory it keeps, and from what size on it keeps none."""

KEPT_BYTES, LARGEST_KEPT = 1 << 25, 1 << 24
"""What is kept at most, and its largest piece [bytes]: a few faces of a cube, as they are filtered."""


def check_memory(
    needed: float, what: str, size: tuple[int, int], besides: float = 0.0, powers: bool = False
) -> None:
    """Refuse work for which this machine has too little memory, before it begins.

    Parameters
    ----------
    needed : float
        Bytes, in proportion to the number of texels.
    what : str
        Subject of the message: the thing that needs the memory.
    size : tuple of int
        Width and height of the picture, in texels.
    besides : float
        Bytes that do not depend on the size.
    powers : bool
        Whether sizes are powers of two.

    Raises
    ------
    MemoryShortageError
        It does not fit; the message names a size that does, if there is one.
    """
    whole = memory_left()
    left = whole - besides
    if left <= needed / (size[0] * size[1]):
        raise MemoryShortageError(
            f"{what} takes {besides / 1e9:.1f} GB of memory at any size, and {whole / 1e9:.1f} GB are left: "
            f"close other programs, or raise the limit."
        )
    if needed > left:
        scale = math.sqrt(left / needed)
        if powers:
            scale = 2.0 ** math.floor(math.log2(scale))
        fitting = "x".join(str(max(1, math.floor(side * scale))) for side in size)
        raise MemoryShortageError(
            f"{what} takes {needed / 1e9:.1f} GB of memory at {size[0]}x{size[1]}, and {left / 1e9:.1f} GB "
            f"are left: shrink it to {fitting} at most."
        )


def memory_left() -> float:
    """Bytes that this process can still take; infinite where the system does not tell.

    The least of what the machine has, of what its control groups leave (the limit of a container or job), and
    of what the process's own limit leaves.
    """
    return max(0.0, min((_machine(), _address_space(), *_control_groups()), default=math.inf))


def _machine() -> float:
    if sys.platform == "win32":
        import ctypes

        kilobytes = ctypes.c_ulonglong()
        ctypes.windll.kernel32.GetPhysicallyInstalledSystemMemory(ctypes.byref(kilobytes))
        return 1024.0 * kilobytes.value or math.inf
    for line in _lines(ROOT / "proc/meminfo"):
        if line.startswith("MemAvailable:"):
            return 1024.0 * int(line.split()[1])
    return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def address_limit() -> float:
    """Bytes of addresses that a process may have, used or not; infinite where there is no limit."""
    if sys.platform == "win32":
        return math.inf
    import resource

    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    return math.inf if limit == resource.RLIM_INFINITY else float(limit)


def _address_space() -> float:
    pages = _lines(ROOT / "proc/self/statm")
    return address_limit() - int(pages[0].split()[0]) * os.sysconf("SC_PAGE_SIZE") if pages else math.inf


def _control_groups() -> Iterator[float]:
    """Memory that each control group above this process leaves, in either version of Linux's groups."""
    for line in _lines(ROOT / "proc/self/cgroup"):
        _, controllers, group = line.split(":", 2)
        if controllers == "":
            root, limit, used = ROOT / "sys/fs/cgroup", "memory.max", "memory.current"
        elif "memory" in controllers.split(","):
            root = ROOT / "sys/fs/cgroup/memory"
            limit, used = "memory.limit_in_bytes", "memory.usage_in_bytes"
        else:
            continue
        names = Path(group.lstrip("/")).parts
        for depth in range(len(names) + 1):
            level = root.joinpath(*names[:depth])
            numbers = [_number(level / name) for name in (limit, used)]
            if None not in numbers:
                # The system frees memory of cached files on demand
                kept = sum(
                    int(line.split()[1])
                    for line in _lines(level / "memory.stat")
                    if line.startswith("inactive_file ")
                )
                yield float(numbers[0] or 0) - float(numbers[1] or 0) + kept


def keep_freed_memory() -> None:
    """Have the process keep some of the memory that it frees for what it asks for next.

    glibc gives an array's memory back as soon as it is freed, and the system clears the next one's pages.
    """
    if sys.platform == "linux":
        import ctypes

        library = ctypes.CDLL(None)
        if hasattr(library, "mallopt"):  # not in musl
            library.mallopt(M_TRIM_THRESHOLD, KEPT_BYTES)
            library.mallopt(M_MMAP_THRESHOLD, LARGEST_KEPT)


def _number(path: Path) -> int | None:
    """A file's number; None where the file is missing or says "max"."""
    text = "".join(_lines(path))
    return int(text) if text.isdigit() else None


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text().splitlines()
    except OSError:
        return []

"""What limits the memory of a process is heeded: the machine's, a control group's, its own."""

import math
import platform
import subprocess
import sys
from pathlib import Path

import pytest
from rsibr.rsibr_addon.core.errors import MemoryShortageError
from rsibr.rsibr_addon.files import memory

GIB = 2**30


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """What Linux tells, with 8 GiB left on the machine and no other limit."""
    monkeypatch.setattr(memory, "ROOT", tmp_path)
    write(tmp_path / "proc/meminfo", f"MemTotal: {16 * 2**20} kB\nMemAvailable: {8 * 2**20} kB\n")
    return tmp_path


def write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def group(folder: Path, names: tuple[str, str], limit: object, used: int, kept: int = 0) -> None:
    for name, number in zip(names, (limit, used), strict=True):
        write(folder / name, f"{number}\n")
    write(folder / "memory.stat", f"anon 5\ninactive_file {kept}\nactive_file 7\n")


V1, V2 = ("memory.limit_in_bytes", "memory.usage_in_bytes"), ("memory.max", "memory.current")


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
class TestLinux:
    """Files that tell."""

    def test_the_machine(self, root: Path) -> None:
        assert memory.memory_left() == 8 * GIB

    def test_a_group_of_version_2_and_those_above_it(self, root: Path) -> None:
        write(root / "proc/self/cgroup", "0::/user.slice/job: 7\n")
        folder = root / "sys/fs/cgroup"
        group(folder / "user.slice/job: 7", V2, "max", GIB)
        assert memory.memory_left() == 8 * GIB
        group(folder / "user.slice", V2, 4 * GIB, GIB)
        assert memory.memory_left() == 3 * GIB
        group(folder / "user.slice/job: 7", V2, 2 * GIB, GIB)
        assert memory.memory_left() == GIB
        # A container's own is the root that it sees
        group(folder, V2, GIB, GIB // 2)
        assert memory.memory_left() == GIB // 2

    def test_a_group_of_version_1(self, root: Path) -> None:
        write(root / "proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/box\n1:cpuset:/other\n0::/\n")
        group(root / "sys/fs/cgroup/memory/box", V1, 2 * GIB, GIB)
        group(root / "sys/fs/cgroup/other", V2, 1, 1)
        assert memory.memory_left() == GIB
        # No limit is a very large number there
        group(root / "sys/fs/cgroup/memory/box", V1, 2**63 - 4096, GIB)
        assert memory.memory_left() == 8 * GIB

    def test_files_that_the_system_keeps_in_memory_count_as_free(self, root: Path) -> None:
        write(root / "proc/self/cgroup", "0::/box\n")
        group(root / "sys/fs/cgroup/box", V2, 2 * GIB, 2 * GIB, kept=GIB)
        assert memory.memory_left() == GIB

    def test_a_group_beyond_its_limit_leaves_nothing(self, root: Path) -> None:
        write(root / "proc/self/cgroup", "0::/box\n")
        group(root / "sys/fs/cgroup/box", V2, GIB, 2 * GIB)
        assert memory.memory_left() == 0.0

    def test_the_limit_on_addresses(self) -> None:
        code = (
            "import resource; resource.setrlimit(resource.RLIMIT_AS, (2**32, 2**32));"
            "from rsibr.rsibr_addon.files.memory import address_limit, memory_left;"
            "print(address_limit(), memory_left())"
        )
        told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        limit, left = map(float, told.stdout.split())
        assert limit == 2**32
        assert 0.0 < left < 2**32


@pytest.mark.parametrize("left", [0.0, 1e9, 1e9 + 1.0])
def test_what_fits_at_no_size_says_so(left: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "memory_left", lambda: left)
    with pytest.raises(
        MemoryShortageError, match=r"^out.exr takes 1\.0 GB of memory at any size, .* close other"
    ):
        memory.check_memory(3e9, "out.exr", (1000, 1000), besides=1e9)


@pytest.mark.parametrize("left", [1e9, 0.9e9, 1e6, 3e3])
def test_sizes_that_are_powers_of_two_are_offered_where_no_others_will_do(
    left: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, "memory_left", lambda: left)
    with pytest.raises(MemoryShortageError) as caught:
        memory.check_memory(3e9, "out.exr", (1024, 1024), powers=True)
    size = int(str(caught.value).split("shrink it to ")[1].split("x")[0])
    assert math.log2(size) % 1.0 == 0.0
    assert 3e9 * (size / 1024) ** 2 <= left < 3e9 * (2 * size / 1024) ** 2


FAULTS = """
import resource
from rsibr.rsibr_addon.files.memory import keep_freed_memory

{}
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(10):
    pieces = [b"x" * (12 << 20) for _ in range(2)]
    del pieces
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""
"""Pages that the system clears for pieces which are freed together, again and again."""


@pytest.mark.skipif(sys.platform != "linux" or not platform.libc_ver()[0], reason="glibc alone is told")
def test_freed_memory_is_used_again() -> None:
    cleared = [
        int(
            subprocess.run(
                [sys.executable, "-c", FAULTS.format(told)], capture_output=True, check=True
            ).stdout
        )
        for told in ("", "keep_freed_memory()")
    ]
    # Of the pages of ten rounds, those of the first remain
    assert cleared[1] < cleared[0] / 5

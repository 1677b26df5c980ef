"""Kernel banks as files: what is written comes back, and everything else is named."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.core.environment import Environment
from rsibr.rsibr_addon.core.errors import MapSetError
from rsibr.rsibr_addon.core.kinds.kernel_bank.filtered_bank import FilteredBank
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS, stack_representation
from rsibr.rsibr_addon.core.lobes.bake import BakedBank
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.files.kinds.kernel_bank import from_map_set, to_map_set
from rsibr.rsibr_addon.files.map_set import read_map_set, write_map_set
from rsibr.rsibr_addon.files.map_set_data import MapSet
from rsibr.rsibr_addon.files.map_set_header import Origin

RNG = np.random.default_rng(4)
LIGHT = Environment(RNG.random((8, 16, 3), dtype=np.float32), "light")


def make_map_set(layout: str = "dual_paraboloid") -> tuple[FilteredBank, MapSet]:
    maps = RNG.random((3, *stack_representation(layout, 8).shape(8), 3), dtype=np.float32)
    filtered = FilteredBank(layout, KernelBank((0.5, 1.0, 2.0)), maps, RNG.random((3, 3)))
    return filtered, to_map_set(
        BakedBank(filtered, (0.001, 0.002, 0.003)), Origin(LIGHT, {"size": 8}, "a test")
    )


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_bank_comes_back_bit_by_bit(tmp_path: Path, layout: str) -> None:
    filtered, map_set = make_map_set(layout)
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set)
    held = read_map_set(path, "kernel_bank")
    back = from_map_set(path, held)
    assert (back.layout, back.bank) == (layout, filtered.bank)
    np.testing.assert_array_equal(back.maps, filtered.maps)
    np.testing.assert_array_equal(back.bound, filtered.bound)
    assert held.header["error_bound"]["interpolation"] == 0.003
    np.testing.assert_array_equal(held.header["error_bound"]["filter"], filtered.bound.max(axis=0))


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda header, parts: header.update(layout="equirect"), "cannot be laid out as equirect"),
        (lambda header, parts: parts["kernel01"].update(concentration=0.5), "Kernels need concentrations"),
        (lambda header, parts: parts["kernel01"].update(concentration=-1.0), "Kernels need concentrations"),
        (lambda header, parts: header.update(size=[4, 8]), "does not have 2 sheets"),
        (
            lambda header, parts: [part.update(role="other") for part in parts.values()],
            "Kernels need concentrations",
        ),
    ],
)
def test_what_is_no_kernel_bank_is_named(tmp_path: Path, spoil: Callable, sentence: str) -> None:
    _, map_set = make_map_set()
    parts = {part["name"]: part for part in map_set.header["parts"]}
    spoil(map_set.header, {name: part for name, part in parts.items() if name != "environment"})
    path = tmp_path / "a.rsibr.exr"
    write_map_set(path, map_set)
    with pytest.raises(MapSetError, match=f"{path} holds no kernel bank. .*{sentence}"):
        from_map_set(path, read_map_set(path))

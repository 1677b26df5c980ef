"""Thinning: what is left out costs least, from the ends of its widths, and no more than is allowed."""

import numpy as np
from rsibr.rsibr_addon.core.lobes.thinning import Equations, solution, thinned

WIDTHS, ELEVATIONS, LOBES, KERNELS, NODES = 4, 3, 2, 6, 60


def problems(rng: np.random.Generator) -> list[list[tuple[np.ndarray, np.ndarray]]]:
    """Least-squares problems of each width and elevation: columns, and two targets."""
    return [
        [
            (rng.normal(size=(NODES, LOBES * KERNELS)), rng.normal(size=(NODES, 2)) + 3.0)
            for _ in range(ELEVATIONS)
        ]
        for _ in range(WIDTHS)
    ]


def equations_of(columns: np.ndarray, target: np.ndarray) -> Equations:
    return columns.T @ columns, columns.T @ target


def squared_error(problem: tuple[np.ndarray, np.ndarray], kept: np.ndarray) -> float:
    columns, target = problem
    return float(np.sum((columns @ solution(equations_of(*problem), kept) - target) ** 2))


def errors_of(rows: list[list[tuple[np.ndarray, np.ndarray]]], kept: np.ndarray) -> np.ndarray:
    pairs = zip(rows, kept, strict=True)
    return np.array([sum(squared_error(each, of) for each in row) for row, of in pairs])


def test_no_width_errs_more_than_is_allowed_and_each_by_as_much_as_it_may() -> None:
    rows = problems(np.random.default_rng(1))
    whole = np.ones((WIDTHS, KERNELS), dtype=bool)
    before, most = errors_of(rows, whole), 0.03
    kept = thinned([[equations_of(*each) for each in row] for row in rows], before, most, KERNELS)
    assert 0 < np.count_nonzero(~kept) < kept.size
    assert np.all(errors_of(rows, kept) <= (1.0 + most) * before * (1.0 + 1e-9))
    for width, kernel in np.argwhere(kept):
        neighbours = [row for row in (width - 1, width + 1) if 0 <= row < WIDTHS]
        if len(neighbours) < 2 or not all(kept[row, kernel] for row in neighbours):
            less = kept.copy()
            less[width, kernel] = False
            assert errors_of(rows, less)[width] > (1.0 + most) * before[width]


def test_what_is_needed_is_one_run_of_widths() -> None:
    kept = np.pad(
        thinned(
            [[equations_of(*each) for each in row] for row in problems(np.random.default_rng(2))],
            np.full(WIDTHS, 1000.0),
            0.05,
            KERNELS,
        ),
        ((1, 1), (0, 0)),
    )
    begins = np.count_nonzero(kept[1:] & ~kept[:-1], axis=0)
    assert begins.max() <= 1


def test_a_kernel_that_is_left_out_has_no_weight_in_any_lobe() -> None:
    columns, target = problems(np.random.default_rng(3))[0][0]
    kept = np.array([True, False, True, True, False, True])
    found = solution(equations_of(columns, target), kept)
    used = np.concatenate([kept, kept])
    expected = np.linalg.lstsq(columns[:, used], target)[0]
    np.testing.assert_allclose(found[used], expected, rtol=1e-9)
    assert not found[~used].any()

"""Materials chosen while one looks: drawn from a kernel bank, they are what a bake would have made."""

from collections.abc import Iterator

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec
from rsibr.rsibr_addon.core.errors import RangeError, RsibrWarning
from rsibr.rsibr_addon.core.geometry.camera import Camera
from rsibr.rsibr_addon.core.kinds.kernel_bank.filtered_bank import FilteredBank
from rsibr.rsibr_addon.core.kinds.kernel_bank.shading import BankLook
from rsibr.rsibr_addon.core.kinds.lobe_stack.shading import StackLook
from rsibr.rsibr_addon.core.lobes.bake import bake_bank, bake_stack
from rsibr.rsibr_addon.core.lobes.layers import layered_fit
from rsibr.rsibr_addon.core.lobes.target import elevation_slices
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.warned import warn
from rsibr.rsibr_addon.device.context import ensure_context
from rsibr.rsibr_addon.device.kinds.lobe_stack import GpuLobeStack
from rsibr.rsibr_addon.device.preview import PreviewRenderer
from rsibr.rsibr_addon.tasks.methods import live_materials
from rsibr.rsibr_addon.tasks.methods.latest_request_worker import LatestRequestWorker
from rsibr.rsibr_addon.tasks.methods.live_materials import KEPT, SLICES, LiveFits, LiveMaterials
from rsibr.tests.core.test_latest_request_worker import wait_until_idle
from rsibr.tests.glsl.test_preview_renderer import SPHERE

CAMERA = Camera((0.4, -1.0, 0.5))
PIXELS = 64
LOOK = BankLook(brdf="ggx:alpha=0.4,f0=0.3/0.6/0.9", lobe_count=2)
LIGHT = 0.2 + np.random.default_rng(7).random((64, 128, 3)) ** 6


@pytest.fixture(scope="module")
def filtered() -> FilteredBank:
    ensure_context()
    return drain(bake_bank(LIGHT, "dual_paraboloid", 32)).filtered


@pytest.fixture
def worker() -> Iterator[LatestRequestWorker]:
    worker = LatestRequestWorker()
    yield worker
    worker.close()


def picture(subject: LiveMaterials | GpuLobeStack, look: BankLook | StackLook) -> np.ndarray:
    return PreviewRenderer(subject).draw(*SPHERE, CAMERA, PIXELS, look)


def test_a_look_is_drawn_as_the_stack_that_a_bake_makes(filtered: FilteredBank) -> None:
    brdf = brdf_from_spec(LOOK.spec, lambda name, path: pytest.fail("nothing is measured"))
    fit = drain(layered_fit(brdf, elevation_slices(SLICES), 2, sharpest=filtered.sharpest))
    stack = drain(bake_stack(LIGHT, fit, "dual_paraboloid", 32)).stack
    expected = picture(GpuLobeStack(stack), StackLook())
    drawn = picture(LiveMaterials(filtered), LOOK)
    # Both are half floats on the GPU, 2^-11 of each lobe's map, and signed lobes are louder than their sum
    np.testing.assert_allclose(drawn, expected, atol=8.0 * 2.0**-11 * expected.max())
    assert np.array_equal(drawn[..., 3], expected[..., 3])


def test_going_back_fits_nothing(filtered: FilteredBank, monkeypatch: pytest.MonkeyPatch) -> None:
    fits = LiveFits()
    materials, other = LiveMaterials(filtered, fits), BankLook(brdf="ward:alpha=0.5,ks=0.7", lobe_count=1)
    first = picture(materials, LOOK)
    assert not np.array_equal(picture(materials, other), first)
    monkeypatch.setattr(live_materials, "layered_fit", lambda *_, **__: pytest.fail("fitted again"))
    assert np.array_equal(picture(materials, LOOK), first)
    # In another light too
    assert LiveMaterials(filtered, fits).is_ready(LOOK)


def test_stacks_that_are_not_drawn_any_more_are_let_go(filtered: FilteredBank) -> None:
    materials = LiveMaterials(filtered)
    looks = [BankLook(brdf=f"lambert:kd={0.1 + 0.05 * n:g}", lobe_count=1) for n in range(KEPT + 4)]
    for look in looks:
        assert materials.is_ready(look)
        assert materials.is_ready(looks[0])  # always in sight
    assert looks[0] in materials._shown
    assert looks[1] not in materials._shown
    assert len(materials._shown) <= KEPT + 2


def test_what_is_no_model_is_told_every_time(filtered: FilteredBank) -> None:
    materials = LiveMaterials(filtered)
    for _ in range(2):
        with pytest.raises(RangeError, match='There is no BRDF model "gold"'):
            picture(materials, BankLook(brdf="gold"))


def test_a_lobe_too_sharp_for_the_maps_is_told(filtered: FilteredBank) -> None:
    with pytest.warns(
        RsibrWarning, match=r"Maps of 32 texels blur ggx:alpha=0\.02.*bake a larger kernel bank"
    ):
        LiveMaterials(filtered).is_ready(BankLook(brdf="ggx:alpha=0.02,f0=0.5", lobe_count=1))


def test_in_a_worker_a_draft_comes_first(filtered: FilteredBank, worker: LatestRequestWorker) -> None:
    materials, look = (
        LiveMaterials(filtered, LiveFits(worker)),
        BankLook(brdf="ward:alpha=0.45,ks=0.6", lobe_count=2),
    )
    empty = picture(materials, look)
    assert not empty.any()
    drafts = []
    while not materials.is_ready(look) or not materials._shown[look].is_final:
        if look in materials._shown:
            drafts.append(materials._shown[look])
    wait_until_idle(worker)
    assert len({id(draft) for draft in drafts}) <= 1
    assert worker.take_news()
    final = picture(materials, look)
    assert final.any()
    assert np.array_equal(picture(LiveMaterials(filtered), look), final)


def test_until_a_look_is_there_the_one_before_it_is_shown(
    filtered: FilteredBank, worker: LatestRequestWorker
) -> None:
    materials = LiveMaterials(filtered, LiveFits(worker))
    looks = [BankLook(brdf=f"ward:alpha={0.3 + 0.1 * n:g},ks=0.5", lobe_count=1) for n in range(4)]
    assert materials.newest(looks[:1]) is None
    while materials.newest(looks[:1]) is None:
        wait_until_idle(worker)
    assert materials.newest(looks) == looks[0]
    # Drawing what is shown requests nothing: the last look is made, those passed over are not
    assert picture(materials, looks[0]).any()
    wait_until_idle(worker)
    assert materials.newest(looks) == looks[3]
    assert looks[1] not in materials._shown
    wrong = BankLook(brdf="gold")
    assert materials.newest([*looks, wrong]) == looks[3]
    wait_until_idle(worker)
    with pytest.raises(RangeError, match="no BRDF model"):
        materials.newest([*looks, wrong])
    assert materials.newest([looks[3], wrong, looks[0]]) == looks[0]


def test_errors_come_out_of_the_worker(filtered: FilteredBank, worker: LatestRequestWorker) -> None:
    materials, look = LiveMaterials(filtered, LiveFits(worker)), BankLook(brdf="gold")
    assert not materials.is_ready(look)
    wait_until_idle(worker)
    with pytest.raises(RangeError, match='There is no BRDF model "gold"'):
        materials.is_ready(look)


def test_warnings_come_out_of_the_worker(
    filtered: FilteredBank, worker: LatestRequestWorker, monkeypatch: pytest.MonkeyPatch
) -> None:
    def read(name: str, path: str) -> Brdf:
        warn("The file is odd.")
        return brdf_from_spec(LOOK.spec, lambda *_: pytest.fail("nothing is measured"))

    monkeypatch.setattr(live_materials, "read_measured", read)
    materials = LiveMaterials(filtered, LiveFits(worker))
    odd, sharp = (
        BankLook(brdf="merl:path=odd", lobe_count=1),
        BankLook(brdf="ggx:alpha=0.02,f0=0.5", lobe_count=1),
    )
    for look, said in ((odd, "The file is odd."), (sharp, "bake a larger kernel bank"), (LOOK, "")):
        assert materials.warning(look) == ""
        while not materials.is_ready(look):
            wait_until_idle(worker)
        assert said in materials.warning(look)
        assert bool(materials.warning(look)) == bool(said)

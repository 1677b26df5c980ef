"""An environment filtered with a bank of kernels: any stack is a sum of its maps."""

import numpy as np
import pytest
from rsibr.rsibr_addon.core.brdf.model import Brdf
from rsibr.rsibr_addon.core.brdf.principled import Principled
from rsibr.rsibr_addon.core.brdf.spec import brdf_from_spec, with_alpha
from rsibr.rsibr_addon.core.conventions import Array, texel_centres
from rsibr.rsibr_addon.core.errors import RangeError, ShapeError
from rsibr.rsibr_addon.core.filtering.prefilter import prefilter_exact, resolved_width
from rsibr.rsibr_addon.core.filtering.radial_lobes import von_mises_fisher_lobe
from rsibr.rsibr_addon.core.filtering.zonal import expand
from rsibr.rsibr_addon.core.geometry.directions import dot, normalize
from rsibr.rsibr_addon.core.kinds.kernel_bank.filtered_bank import FilteredBank, stack_from_bank
from rsibr.rsibr_addon.core.kinds.kernel_bank.shading import BankLook
from rsibr.rsibr_addon.core.kinds.lobe_stack.stack import LAYOUTS
from rsibr.rsibr_addon.core.lobes.bake import ALLOWED_OF_A_KERNEL, BakedBank, bake_bank, bake_stack
from rsibr.rsibr_addon.core.lobes.bank import KernelBank
from rsibr.rsibr_addon.core.lobes.layers import layered_fit
from rsibr.rsibr_addon.core.maps import equirect
from rsibr.rsibr_addon.core.progress import drain
from rsibr.rsibr_addon.core.resample import lookup
from rsibr.tests.lobe_stacks import random_fit

HEIGHT = 64
TEXELS = equirect.direction_from_uv(texel_centres(2 * HEIGHT, HEIGHT))
LIGHT = 0.5 + np.random.default_rng(3).random((HEIGHT, 2 * HEIGHT, 3)) ** 4
LIGHT[20, 50] = 80.0


def model(spec: str) -> Brdf:
    return brdf_from_spec(spec, lambda name, path: pytest.fail("nothing is measured"))


def baked(size: int = 32, layout: str = "dual_paraboloid", radiance: Array = LIGHT) -> BakedBank:
    return drain(bake_bank(radiance, layout, size))


def test_in_the_dark_nothing_is_reflected_and_nothing_errs() -> None:
    dark = np.zeros_like(LIGHT)
    found = baked(radiance=dark)
    fit = random_fit(found.filtered.bank, lobes=1)
    stack = drain(bake_stack(dark, fit, "dual_paraboloid", None))
    assert not found.filtered.maps.any()
    assert not stack.stack.maps.any()
    assert not np.any(found.interpolation)
    assert stack.interpolation == 0.0


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_sum_of_the_bank_is_the_stack_that_is_baked(layout: str) -> None:
    filtered = baked(16, layout).filtered
    fit = random_fit(KernelBank(filtered.bank.concentrations[1:4]))
    stack, bound = stack_from_bank(filtered, fit)
    other = drain(bake_stack(LIGHT, fit, layout, 16))
    # Each is so near to the sum over all texels; rounding to single precision comes on top
    allowed = bound + other.bound + 2.0**-23 * np.abs(other.stack.maps).max()
    assert np.all(np.abs(stack.maps - other.stack.maps) <= allowed)
    for name in ("mu", "scale", "offsets", "taps", "albedo"):
        np.testing.assert_array_equal(getattr(stack, name), getattr(other.stack, name))
    assert stack.layout == layout


def test_a_fitted_material_is_its_lobes_against_every_texel() -> None:
    filtered = baked(16).filtered
    fit = drain(layered_fit(model("ggx:alpha=0.5,f0=0.5"), [0.3, 0.8], 2, sharpest=filtered.sharpest))
    stack, bound = stack_from_bank(filtered, fit)
    axes = filtered.representation.texel_directions(16)[:, ::5, ::5]
    power = LIGHT * equirect.texel_solid_angle(2 * HEIGHT, HEIGHT)[..., None]
    chord = axes[..., None, None, :] - TEXELS
    kernels = fit.bank.values(0.25 * dot(chord, chord))
    exact = np.einsum("lpkc,sijabk,abc->lpsijc", fit.weights, kernels, power)
    error = np.abs(stack.maps[:, :, :, ::5, ::5] - exact)
    # Weights of both signs: what is rounded to single precision is larger than the sum
    loudest = np.einsum("lpkc,sijabk,abc->lpsijc", np.abs(fit.weights), kernels, power).max()
    assert np.all(error <= bound + 2.0**-22 * loudest)
    assert np.all(bound < 1e-4 * exact.max())


def test_a_fit_takes_the_bank_s_kernels_and_no_others() -> None:
    sharp = model("ggx:alpha=0.05,f0=0.5")
    wide, narrow = (drain(layered_fit(sharp, [0.5], 1, sharpest=most)).bank for most in (64.0, 2.0**15))
    assert wide.concentrations[-1] == 64.0
    assert narrow.concentrations[: len(wide)] == wide.concentrations
    filtered = baked(32).filtered
    with pytest.raises(RangeError, match=r"concentration .*: fit with the bank's kernels, or bake a larger"):
        stack_from_bank(filtered, random_fit(narrow))


def test_kernels_that_count_for_nothing_need_not_be_there() -> None:
    filtered = baked(16).filtered
    fit = random_fit(KernelBank((*filtered.bank.concentrations, 2.0**15)))
    fit.weights[:, :, -1] = 0.0
    stack, _ = stack_from_bank(filtered, fit)
    assert np.all(np.isfinite(stack.maps))


def test_larger_maps_hold_sharper_kernels_until_the_environment_ends() -> None:
    small, large, huge = (baked(size) for size in (16, 64, 128))
    assert small.filtered.sharpest < large.filtered.sharpest
    for each in (small, large, huge):
        assert max(each.interpolation) <= ALLOWED_OF_A_KERNEL
        assert np.all(np.diff(each.interpolation) > 0.0)
    sharpest = huge.filtered.sharpest
    widths = [expand(von_mises_fisher_lobe(kappa)).width for kappa in (sharpest, 2.0 * sharpest)]
    assert widths[0] >= resolved_width(HEIGHT) > widths[1]
    with pytest.raises(RangeError, match="An environment of 1 rows resolves no kernel: use a larger one"):
        baked(16, radiance=np.ones((1, 2, 3)))


@pytest.mark.slow
def test_lookups_cost_what_each_kernel_says() -> None:
    found = baked(32)
    direction = normalize(np.random.default_rng(8).normal(size=(600, 3)))
    lobes = found.filtered.bank.lobes()
    exact = prefilter_exact(LIGHT, lobes, direction)
    for kernel, maps in enumerate(found.filtered.maps):
        error = lookup(maps, direction, found.filtered.representation) - exact[kernel]
        relative = np.sqrt(np.sum(error**2) / np.sum(exact[kernel] ** 2))
        # An expectation over light that favours no direction; here is one bright texel
        assert 0.5 < relative / found.interpolation[kernel] < 2.0


def test_shapes_that_do_not_fit_are_refused() -> None:
    filtered = baked(16).filtered
    with pytest.raises(ShapeError, match="bound of a kernel bank cannot have the shape"):
        FilteredBank(filtered.layout, filtered.bank, filtered.maps, filtered.bound[1:])
    with pytest.raises(ShapeError, match="maps of a kernel bank cannot have the shape"):
        FilteredBank("octahedral", filtered.bank, filtered.maps, filtered.bound)


def test_a_roughness_is_every_layer_s() -> None:
    lacquer = "layered:coat=(ggx:alpha=0.1,eta=1.5),base=(ward:ks=0.5, alpha = 0.3)"
    assert model(with_alpha(lacquer, 0.25)) == model(lacquer.replace("0.1", "0.25").replace("0.3", "0.25"))
    assert BankLook(brdf=lacquer, roughness=0.5).spec == with_alpha(lacquer, 0.25)
    assert BankLook(brdf=lacquer).spec == lacquer
    with pytest.raises(RangeError, match=r'"lambert:kd=0\.5" has no alpha to set'):
        BankLook(brdf="lambert:kd=0.5", roughness=0.5)
    with pytest.raises(RangeError, match="Roughness cannot be 0: choose"):
        BankLook(roughness=0.0)
    with pytest.raises(RangeError, match="Lobes cannot be 13: choose 1 to 12"):
        BankLook(lobe_count=13)


def test_a_look_without_a_model_is_the_principled_material_of_its_options() -> None:
    assert BankLook().spec == "principled"
    look = BankLook(base_color=(0.8, 0.5, 0.25), metallic=1.0, roughness=0.25, coat_weight=0.5)
    assert model(look.spec) == Principled(
        base_color=(0.8, 0.5, 0.25), metallic=1.0, roughness=0.25, coat_weight=0.5
    )

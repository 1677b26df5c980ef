"""What a web page shows of a kernel bank: a material that follows its sliders without a fit."""

from dataclasses import fields

from ...core.environment import Environment
from ...core.kinds.kernel_bank.shading import BankLook
from ...core.kinds.kernel_pyramid.bake import bake_pyramid
from ...core.kinds.kernel_pyramid.look import PrincipledLook
from ...core.kinds.principled_material import PrincipledMaterial
from ...core.progress import Steps
from ...files.kinds.kernel_pyramid import to_map_set
from ...files.map_set_data import MapSet
from ...files.map_set_header import Origin
from ...files.version import rsibr

SIZE = 512
"""Texels along the largest maps: pages of some 3.5 MB."""


def pyramid_by_sliders(
    environment: Environment, look: BankLook
) -> Steps[tuple[MapSet, PrincipledLook] | None]:
    """A kernel pyramid of the bank's light, which takes its lobes from the families: `Kind.by_sliders`."""
    if look.brdf is not None:
        return None
    baked = yield from bake_pyramid(environment.radiance, SIZE)
    given = {each.name: getattr(look, each.name) for each in fields(PrincipledMaterial)}
    if look.roughness is None:
        del given["roughness"]
    map_set = to_map_set(baked, Origin(environment, {"size": SIZE}, rsibr()))
    return map_set, PrincipledLook(**given)

"""The ways of making a map set: the command that each is, and what it will cost."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, log2
from pathlib import Path
from typing import Any, ClassVar, Protocol

from ...core.brdf.gallery import gallery_name
from ...core.brdf.lambert import Lambert
from ...core.brdf.spec import MEASURED, brdf_from_spec
from ...core.errors import InputFileError
from ...core.filtering.prefilter import BYTES_BESIDES, bytes_needed
from ...core.lobes.bake import SIZES
from ...host import cycles
from ...host.worlds import LIGHT_OF_TEXEL

BLENDER_MEMORY = 350e6
"""Bytes that a background Blender takes with a small file, before any work."""

BLENDER_SECONDS = 3.0
"""Of processor time to start it."""

WORLD_SECONDS = 15.0
"""Of processor time to sample a world whose lamps are small."""

ENVIRONMENT_TEXELS = 1024 * 512
"""Of one of Blender's own, and of a world."""

STORED = 0.7
"""What remains of a float of radiance when it is compressed: of captures that we made."""

RGB = 3 * 4
"""Bytes of a texel."""

TEXELS_BY_ALPHA = 38.0
"""Width of a map times its lobe's width alpha, as bakes choose it: of Blender's `forest`."""

KERNELS = 12
"""That the lobes of a fit are sums of."""

LOBE_SIZE = 128
"""Of a map, where nothing is known of the lobes."""

MATERIAL = "blend:"
"""Begins the text of a model that is a material of Blender."""

MEASURED_FORMATS = {".binary": "merl", ".brdf": "cornell", ".bsdf": "rgl"}
"""Suffix of a measured material's file -> the model that it is of."""


@dataclass(frozen=True)
class Cost:
    """What making a map set takes, roughly.

    Attributes
    ----------
    processor_seconds : float
        Of all cores together.
    memory : float
        Bytes.
    disk : float
        Bytes, of the finished file.
    """

    processor_seconds: float
    memory: float
    disk: float

    @property
    def seconds(self) -> float:
        """By the clock, where all cores are free; what a single one does is a small part."""
        return self.processor_seconds / (os.cpu_count() or 1)


class Method(Protocol):
    """A way to make a map set, with its settings.

    Attributes
    ----------
    kind : str
        Of the map set.
    subject : str
        What reflects, in words; empty where it is light alone.
    """

    kind: ClassVar[str]

    @property
    def subject(self) -> str:
        """See above."""

    def arguments(self) -> tuple[str, ...]:
        """Of the command line, without environment and output."""

    def cost(self) -> Cost:
        """For an environment as large as those of Blender."""


@dataclass(frozen=True)
class Views:
    """[Cabral1999]: a material rendered from all around.

    Attributes
    ----------
    material : str
        As `host.materials.load_material` takes it.
    views, size, samples : int
    denoise : bool
        See `job.CaptureJob`.
    """

    kind: ClassVar[str] = "radiance_views"

    material: str
    views: int
    size: int
    samples: int
    denoise: bool

    @property
    def subject(self) -> str:
        """See `Method`."""
        return self.material.removeprefix(":")

    def arguments(self) -> tuple[str, ...]:
        """See `Method`."""
        numbers = ("--views", str(self.views), "--size", str(self.size), "--samples", str(self.samples))
        return "capture", "--material", self.material, *numbers, *(("--denoise",) if self.denoise else ())

    def cost(self) -> Cost:
        """See `Method`; measured on a sphere in Blender's `forest`."""
        texels = self.views * self.size**2
        rendering = self.views * (0.5 + 1.5 * self.denoise) + 2.5e-6 * texels * self.samples
        maps = 2 * texels * RGB
        light = LIGHT_OF_TEXEL * ENVIRONMENT_TEXELS
        albedo = 4.0
        return Cost(
            BLENDER_SECONDS + albedo + rendering,
            BLENDER_MEMORY + cycles.bytes_needed(self.size**2, self.denoise) + light,
            STORED * (maps + ENVIRONMENT_TEXELS * RGB),
        )


@dataclass(frozen=True)
class Lobes:
    """[Kautz2000]: an environment filtered with the lobes of a reflectance model.

    Attributes
    ----------
    brdf : str
        As `tasks.reflectance.brdfs.load_brdf` takes it.
    lobes, slices : int
    size : int
        Of a map in texels; 0 for what the lobes need.
    half : bool

    Raises
    ------
    RangeError
        The text describes no model.
    """

    kind: ClassVar[str] = "lobe_stack"

    brdf: str
    lobes: int
    slices: int
    size: int
    half: bool

    def __post_init__(self) -> None:
        _layers_and_size(self.brdf)

    @property
    def subject(self) -> str:
        """See `Method`."""
        named = gallery_name(self.brdf).removeprefix(f"{MATERIAL}:")
        return named if "path=" not in named else Path(named).stem

    def arguments(self) -> tuple[str, ...]:
        """See `Method`."""
        numbers = ("--lobes", str(self.lobes), "--slices", str(self.slices))
        size = ("--size", str(self.size)) if self.size else ()
        return "bake", "--brdf", self.brdf, *numbers, *size, *(("--half",) if self.half else ())

    def cost(self) -> Cost:
        """See `Method`; two paraboloids."""
        layers, size = _layers_and_size(self.brdf)
        maps = layers * self.lobes * self.slices * 2 * (self.size or size) ** 2 * RGB
        measuring = 12.0 * self.brdf.startswith(MATERIAL)
        fitting = 0.01 * layers * self.lobes * self.slices
        filtering = 1.0 + 4e-8 * maps
        stored = 0.2 if self.half else STORED
        return Cost(
            BLENDER_SECONDS + measuring + fitting + filtering,
            BLENDER_MEMORY + BYTES_BESIDES + bytes_needed(KERNELS, 2 * (self.size or size) ** 2),
            stored * maps + STORED * ENVIRONMENT_TEXELS * RGB,
        )


def _layers_and_size(spec: str) -> tuple[int, int]:
    """How many layers a model has, and how large its maps will be: roughly, by its sharpest lobe."""
    if spec.startswith((MATERIAL, *MEASURED)):
        return 1, LOBE_SIZE
    layers = brdf_from_spec(spec, lambda name, path: Lambert(kd=0.5)).layers
    alpha = min(getattr(layer, "alpha", 1.0) for layer in layers)
    return len(layers), min(2 ** ceil(log2(TEXELS_BY_ALPHA / alpha)), SIZES[-1])


@dataclass(frozen=True)
class Tables:
    """[Miller1984]: tables of what a material of a few parts reflects.

    Attributes
    ----------
    material : str
        One of `core.kinds.reflection_tables.material.PRESETS`.
    diffuse_rows : int
    rows : int
        Of the other tables; 0 for what their lobes need.
    """

    kind: ClassVar[str] = "reflection_tables"

    material: str
    diffuse_rows: int
    rows: int

    @property
    def subject(self) -> str:
        """See `Method`."""
        return self.material

    def arguments(self) -> tuple[str, ...]:
        """See `Method`."""
        rows = ("--rows", str(self.rows)) if self.rows else ()
        return "tables", "--material", self.material, "--diffuse-rows", str(self.diffuse_rows), *rows

    def cost(self) -> Cost:
        """See `Method`; with a mirror's table, as large as the environment where the rows are left open."""
        maps = (2 * self.diffuse_rows**2 + 2 * (self.rows or 512) ** 2) * RGB
        diffuse = 3e-4 * self.diffuse_rows**2
        return Cost(
            BLENDER_SECONDS + 0.5 + diffuse + 1.5e-7 * maps,
            BLENDER_MEMORY + BYTES_BESIDES + bytes_needed(1, 2 * (self.rows or 512) ** 2) + maps,
            STORED * (maps + ENVIRONMENT_TEXELS * RGB),
        )


@dataclass(frozen=True)
class Mips:
    """[Kautz2004]: an environment's cube map, ever more filtered.

    Attributes
    ----------
    filter : str
    size : int
    roughness : str
        See `tasks.methods.mip_chain.MipSettings`.
    """

    kind: ClassVar[str] = "mip_chain"

    filter: str
    size: int
    roughness: str

    @property
    def subject(self) -> str:
        """See `Method`."""
        return ""

    def arguments(self) -> tuple[str, ...]:
        """See `Method`."""
        roughness = ("--roughness", self.roughness) if self.filter == "ggx" else ()
        return "mips", "--filter", self.filter, "--size", str(self.size), *roughness

    def cost(self) -> Cost:
        """See `Method`; all mips together are a third more than the first."""
        maps = 6 * self.size**2 * RGB * 4 / 3
        filtering = 1.0 + 5e-8 * maps if self.filter == "ggx" else 0.5
        return Cost(
            BLENDER_SECONDS + filtering,
            BLENDER_MEMORY + BYTES_BESIDES + bytes_needed(1, 6 * self.size**2) + maps,
            STORED * (maps + ENVIRONMENT_TEXELS * RGB),
        )


@dataclass(frozen=True)
class Bank:
    """An environment filtered with kernels that the lobes of any material are sums of.

    Attributes
    ----------
    size : int
        Of a map in texels.
    """

    kind: ClassVar[str] = "kernel_bank"

    size: int

    @property
    def subject(self) -> str:
        """See `Method`."""
        return ""

    def arguments(self) -> tuple[str, ...]:
        """See `Method`."""
        return "bank", "--size", str(self.size)

    def cost(self) -> Cost:
        """See `Method`; two paraboloids for each kernel, two kernels more when maps are twice as wide."""
        kernels, texels = int(2 * log2(self.size)), 2 * self.size**2
        maps = kernels * texels * RGB
        return Cost(
            BLENDER_SECONDS + 0.5 + 1e-7 * maps,
            BLENDER_MEMORY + BYTES_BESIDES + bytes_needed(kernels, texels) + maps,
            STORED * (maps + ENVIRONMENT_TEXELS * RGB),
        )


def _views(chosen: Any, source: str) -> Views:
    material = f":{source}" if chosen.source == "OWN" else chosen.preset
    return Views(material, int(chosen.views), chosen.size, chosen.samples, chosen.denoise)


def _lobes(chosen: Any, source: str) -> Lobes:
    match chosen.source:
        case "OWN":
            brdf = f"{MATERIAL}:{source}"
        case "MODEL":
            brdf = chosen.brdf
        case _:
            brdf = measured_spec(source)
    return Lobes(brdf, chosen.lobes, chosen.slices, chosen.size, chosen.half)


METHODS: dict[str, Callable[[Any, str], Method]] = {
    Views.kind: _views,
    Lobes.kind: _lobes,
    Tables.kind: lambda chosen, source: Tables(chosen.preset, chosen.diffuse_rows, chosen.rows),
    Mips.kind: lambda chosen, source: Mips(chosen.filter, int(chosen.size), chosen.roughness),
    Bank.kind: lambda chosen, source: Bank(int(chosen.size)),
}
"""Kind -> what makes a method of its settings, as `ui.bake_properties` has them, and of the name of the
object's own material or the path of a measured one, where the settings say so."""

QUALITIES: dict[str, dict[str, dict[str, Any]]] = {
    "DRAFT": {
        Views.kind: {"views": "12", "size": 64, "samples": 16, "denoise": True},
        Lobes.kind: {"lobes": 2, "slices": 8, "size": 32, "half": True},
        Tables.kind: {"diffuse_rows": 18, "rows": 128},
        Mips.kind: {"size": "64"},
        Bank.kind: {"size": "64"},
    },
    "GOOD": {
        Views.kind: {"views": "12", "size": 256, "samples": 32, "denoise": True},
        Lobes.kind: {"lobes": 3, "slices": 16, "size": 0, "half": True},
        Tables.kind: {"diffuse_rows": 36, "rows": 0},
        Mips.kind: {"size": "256"},
        Bank.kind: {"size": "128"},
    },
    "FINAL": {
        Views.kind: {"views": "42", "size": 512, "samples": 128, "denoise": False},
        Lobes.kind: {"lobes": 5, "slices": 32, "size": 0, "half": False},
        Tables.kind: {"diffuse_rows": 72, "rows": 1024},
        Mips.kind: {"size": "512"},
        Bank.kind: {"size": "256"},
    },
}
"""Quality -> kind -> settings in a file that it stands for."""


def measured_spec(path: str) -> str:
    """The text of a measured material's file.

    Parameters
    ----------
    path : str

    Returns
    -------
    str
        As `files.brdfs.brdf_from_spec` takes it.

    Raises
    ------
    InputFileError
        Its suffix is none of `MEASURED_FORMATS`.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in MEASURED_FORMATS:
        raise InputFileError(
            f"{path} is no measured material: give a MERL .binary, a Cornell .brdf or an RGL .bsdf."
        )
    return f"{MEASURED_FORMATS[suffix]}:path={path}"

"""What a report shows beside what its map set holds."""

from dataclasses import dataclass

from ..core.options import Options, option


@dataclass(frozen=True, kw_only=True)
class ReportOptions(Options):
    """What is plotted."""

    brdf: str | None = option(
        None,
        label="Model",
        help="The model to plot beside a lobe stack's lobes, where it is in a file, as rsibr bake takes it",
        none="what the map set names",
        metavar="SPEC",
    )

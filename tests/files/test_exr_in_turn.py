"""An OpenEXR file written part by part has the bytes of one written whole."""

from pathlib import Path

import numpy as np
import pytest
from rsibr.rsibr_addon.files.exr import write_parts
from rsibr.rsibr_addon.files.exr_in_turn import PartsInTurn
from rsibr.rsibr_addon.files.exr_part import Part

RNG = np.random.default_rng(0)
MAPS = {
    "cover": np.zeros((40, 50, 3), np.float16),
    "one texel": RNG.random((1, 1, 3), np.float32),
    "a chunk": RNG.random((16, 50, 3), np.float32),
    "a chunk and a row": RNG.random((17, 3, 3)).astype(np.float16),
    "a name of more than thirty-two letters": RNG.random((40, 7, 3), np.float32),
    "more than is packed at once": np.tile(RNG.random((1, 70000, 3), np.float32), (37, 1, 1)),
    "a chunk and a row of a wide one": RNG.random((33, 4096, 3), np.float32),
    "a wide black": np.zeros((40, 4096, 3), np.float16),
    "a last black": np.zeros((32, 9, 3), np.float16),
    "a low black": np.zeros((5, 9, 3), np.float16),
}


@pytest.mark.parametrize("attribute", ["rsibr", "a first one"])
def test_bytes_are_those_of_the_package(tmp_path: Path, attribute: str) -> None:
    texts = ["the text, at last: é", "as long before this:"]
    texts[1] += "." * (len(texts[0].encode()) - len(texts[1]))
    with (tmp_path / "in turn").open("wb") as stream:
        file = PartsInTurn(
            stream, {name: pixels.shape[:2] for name, pixels in MAPS.items()}, attribute, texts[1]
        )
        for name, pixels in MAPS.items():
            if pixels.any():
                file.add(name, pixels)
            else:
                file.add_black(name)
        file.finish(texts[0])
    parts = [
        Part(name, {channel: pixels[..., i] for i, channel in enumerate("RGB")}, {})
        for name, pixels in MAPS.items()
    ]
    parts[0].attributes[attribute] = texts[0]
    write_parts(tmp_path / "whole", parts)
    assert (tmp_path / "in turn").read_bytes() == (tmp_path / "whole").read_bytes()

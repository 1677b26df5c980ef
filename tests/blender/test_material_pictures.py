"""Pictures of materials for panels: one at a time, the last that was wanted next."""

from collections.abc import Iterator

import numpy as np
import pytest
from rsibr.rsibr_addon.core.errors import RangeError
from rsibr.rsibr_addon.session import material_pictures
from rsibr.rsibr_addon.session.material_pictures import MaterialPictures
from rsibr.rsibr_addon.tasks.reflectance.material_picture import material_picture

SECONDS = 60.0
"""Longer than any picture takes."""


@pytest.fixture
def pictures() -> Iterator[MaterialPictures]:
    opened = MaterialPictures(has_windows=True)
    yield opened
    opened.close()


def take(pictures: MaterialPictures) -> float | None:
    """What Blender's timer does once a picture is made."""
    assert pictures._making is not None
    pictures._making.exception(timeout=SECONDS)
    return pictures._take()


def test_a_picture_comes_when_it_is_made(pictures: MaterialPictures) -> None:
    pictures.icon("lambert:kd=0.5")
    assert take(pictures) is None
    wanted = material_picture("lambert:kd=0.5")
    kept = pictures._icons["lambert:kd=0.5"]
    assert tuple(kept.image_size) == wanted.shape[1::-1]
    # As Blender keeps pictures: in 8 bits
    np.testing.assert_allclose(kept.image_pixels_float[:], wanted.ravel(), atol=1.0 / 255.0)
    pictures.icon("lambert:kd=0.5")
    assert pictures._making is None


def test_what_a_slider_has_passed_is_not_made(
    pictures: MaterialPictures, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []

    def noted(spec: str) -> object:
        made.append(spec)
        return material_picture(spec)

    monkeypatch.setattr(material_pictures, "material_picture", noted)
    for value in (0.1, 0.2, 0.3):
        pictures.icon(f"lambert:kd={value}")
    assert take(pictures) is not None
    assert take(pictures) is None
    assert made == ["lambert:kd=0.1", "lambert:kd=0.3"]


def test_a_text_that_is_no_model_is_tried_once(pictures: MaterialPictures) -> None:
    with pytest.raises(RangeError):
        material_picture("velvet:")
    pictures.icon("velvet:")
    take(pictures)
    assert pictures.icon("velvet:") == 0
    assert pictures._making is None


def test_without_windows_nothing_is_made() -> None:
    pictures = MaterialPictures(has_windows=False)
    assert pictures.icon("lambert:kd=0.5") == 0
    assert pictures._making is None
    pictures.close()

"""PNG and TIFF files of 16 bits hold the light on the tone curve: OpenCV reads them back."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.errors import RenderError
from minirt.rendering.image import Image
from minirt.rendering.tone_mapping import light_of
from tests.formats.pictures import SIZES, light, picture

cv2 = pytest.importorskip("cv2")


def curve(made: np.ndarray, tone: str) -> np.ndarray:
    """Levels in [0, 1] of light, by the formulas of IEC 61966-2-1 and of Narkowicz, in long doubles."""
    x = made.astype(np.longdouble)
    if tone == "filmic":
        x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
    x = np.clip(x, 0, 1)
    return x if tone == "plain" else np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / np.longdouble(2.4)) - 0.055)


@pytest.mark.parametrize("name", ["a.png", "a.tif", "a.TIFF"])
@pytest.mark.parametrize("tone", ["plain", "srgb", "filmic"])
@pytest.mark.parametrize("size", SIZES)
def test_levels_are_the_nearest_to_the_light_on_the_curve(
    tmp_path: Path, name: str, tone: str, size: tuple[int, int]
) -> None:
    picture(*size, tone).save(tmp_path / name, bits=16)
    found = cv2.imread(str(tmp_path / name), cv2.IMREAD_UNCHANGED)[..., ::-1]
    assert found.dtype == np.uint16
    assert np.abs(found - 65535 * curve(light(*size), tone)).max() < 0.501


@pytest.mark.parametrize("tone", ["plain", "srgb", "filmic"])
def test_both_depths_agree_and_levels_stand_for_their_light(tone: str) -> None:
    levels = np.arange(256, dtype=np.uint8)
    made = light_of(levels / 255, tone)
    image = Image(np.zeros((1, 256, 3), np.uint8), np.repeat(made[None, :, None], 3, axis=2), None, tone)
    assert np.abs(image.deep[0, :, 0] - 257.0 * levels).max() <= 1


def test_pillow_reads_the_upper_bits_of_png() -> None:
    image = picture(20, 30)
    with pillow.open(io.BytesIO(image.encode("PNG", bits=16))) as file:
        assert np.array_equal(np.asarray(file), image.deep >> 8)


def test_16_bits_need_light_and_a_format_that_has_them() -> None:
    with pytest.raises(RenderError, match="16 bits need linear light"):
        Image(np.zeros((2, 2, 3), np.uint8)).encode("PNG", bits=16)
    with pytest.raises(RenderError, match="JPEG has 8 bits a channel, got 16: try PNG or TIFF"):
        picture(2, 2).encode("JPEG", bits=16)
    with pytest.raises(RenderError, match="EXR has 32 bits a channel, got 16"):
        picture(2, 2).encode("EXR", bits=16)

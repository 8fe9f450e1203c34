"""Tone curves, compared with formulas that are written down here independently, forwards."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.rendering.developing.develop import develop
from minirt.rendering.developing.tone import tone_named
from minirt.scene.elements import TONES

LIGHT = np.concatenate([[0.0, 1e-300, 1e300], np.linspace(0, 1.2, 60_001), np.geomspace(1e-6, 50, 40_001)])


def encode(light: float) -> float:
    """The transfer function of sRGB, IEC 61966-2-1:1999, 5.2."""
    return 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055


def narkowicz(light: float) -> float:
    """The curve that Narkowicz published in 2015."""
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14) if light < 1e9 else 1.0


CURVES = {
    "plain": lambda light: light,
    "srgb": encode,
    "filmic": lambda light: encode(min(narkowicz(light), 1.0)),
}


def levels(light: np.ndarray, tone: str, dither: bool = False) -> np.ndarray:
    """The levels of grey light."""
    pixels = np.zeros((*light.shape, 4), np.uint8)
    develop(np.repeat(light[..., None], 3, axis=-1), pixels, tone, dither)
    assert (pixels[..., 3] == 255).all()
    assert (pixels[..., :1] == pixels[..., :3]).all()
    return pixels[..., 0]


@pytest.mark.parametrize("tone", TONES)
def test_levels_are_the_nearest_on_the_curve(tone: str) -> None:
    exact = np.array([255 * min(CURVES[tone](light), 1.0) for light in LIGHT.tolist()])
    made = levels(LIGHT[None], tone)[0]
    assert np.abs(made - exact).max() <= 0.5 + 1e-9
    assert (made == np.floor(exact + 0.5)).mean() > 0.9999  # others lie half-way but for rounding


def test_every_curve_is_tested_and_an_unknown_one_is_an_error() -> None:
    assert set(CURVES) == set(TONES)
    with pytest.raises(KeyError):
        tone_named("sRGB")


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_all_levels_come_back_from_the_light_that_they_stand_for(tone: str, dither: bool) -> None:
    light = tone_named(tone).light
    assert [255 * CURVES[tone](each) for each in light.tolist()] == pytest.approx(range(256), abs=1e-9)
    assert (levels(np.tile(light, (70, 1)), tone, dither) == np.arange(256)).all()


def test_a_wrong_curve_is_noticed() -> None:
    """A power of 2.2, and sRGB with the threshold of light applied to levels, are not sRGB."""
    light = tone_named("srgb").light
    values = np.arange(256) / 255
    for wrong in (values**2.2, np.where(values <= 0.0031308, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)):
        with pytest.raises(AssertionError):
            assert [255 * encode(each) for each in wrong.tolist()] == pytest.approx(range(256), abs=1e-9)
    assert np.abs(light - values**2.2).max() > 1e-3


def test_the_standard_has_known_values() -> None:
    light = tone_named("srgb").light
    assert light[[0, 255]].tolist() == [0, 1]
    assert light[[10, 11, 128, 188]] == pytest.approx([0.00303527, 0.00334654, 0.21586050, 0.50288646], abs=1e-8)


def test_filmic_keeps_differences_far_above_white() -> None:
    assert tone_named("filmic").light[255] == pytest.approx(7.2417, abs=1e-4)
    assert 200 < levels(np.array([[1.0]]), "filmic")[0, 0] < levels(np.array([[3.0]]), "filmic")[0, 0] < 255

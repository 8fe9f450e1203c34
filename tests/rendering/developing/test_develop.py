"""Developing: dithering keeps the mean, strips and threads make no difference, the stated error of levels is true."""

from __future__ import annotations

from threading import Thread

import numpy as np
import pytest

from minirt.rendering.developing import develop as developing
from minirt.rendering.developing.blue_noise import SIZE, blue_noise
from minirt.rendering.developing.develop import clipped_pixels, develop, rounding_error
from minirt.rendering.developing.steps import Steps
from minirt.rendering.developing.tone import tone_named
from minirt.scene.elements import TONES
from tests.rendering.developing.test_tone import levels

RANDOM = np.random.default_rng(17)
PICTURE = RANDOM.random((77, 93, 3)) * 1.3


def developed(light: np.ndarray, tone: str, dither: bool, threads: int = 1) -> np.ndarray:
    """The pixels of a picture."""
    pixels = np.zeros((*light.shape[:2], 4), np.uint8)
    develop(light, pixels, tone, dither, threads=threads)
    return pixels


@pytest.mark.parametrize("tone", TONES)
def test_dithering_keeps_the_mean_light_of_even_areas(tone: str) -> None:
    light = tone_named(tone).light
    for flat in [*RANDOM.uniform(0, light[-1], 40), *RANDOM.uniform(0, light[3], 10)]:
        made = levels(np.full((SIZE, SIZE), flat), tone, dither=True)
        above = int(np.searchsorted(light, flat))
        assert set(np.unique(made)) <= {above - 1, above}  # no worse than one level
        assert abs(light[made].mean() - flat) <= (light[above] - light[above - 1]) / SIZE**2


def test_dithering_by_other_thresholds_would_be_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong in (np.full((SIZE, SIZE), 0.5), blue_noise() * 0.99, np.square(blue_noise())):
        monkeypatch.setattr(developing, "blue_noise", lambda wrong=wrong: wrong)
        with pytest.raises(AssertionError):
            test_dithering_keeps_the_mean_light_of_even_areas("plain")


def test_small_parts_of_an_even_area_have_nearly_its_mean() -> None:
    """Blue noise: a random pattern would be three times as far off."""
    share = 0.37
    made = levels(np.full((SIZE, SIZE), (100 + share) / 255), "plain", dither=True) - 100
    blocks = made.reshape(SIZE // 8, 8, SIZE // 8, 8).mean(axis=(1, 3))
    random = np.sqrt(share * (1 - share) / 64)
    assert np.sqrt(np.square(blocks - share).mean()) < random / 3


def test_dithering_has_no_low_frequencies_and_no_seam() -> None:
    spectrum = np.abs(np.fft.fft2(blue_noise() - 0.5)) ** 2  # of the endlessly repeated square
    low = np.minimum(np.arange(SIZE), SIZE - np.arange(SIZE))
    distance = np.hypot(*np.meshgrid(low, low))
    assert spectrum[(distance > 0) & (distance < SIZE / 8)].mean() < 0.01 * spectrum[distance > SIZE / 4].mean()


def test_the_thresholds_are_all_different_and_the_same_at_each_start() -> None:
    first = blue_noise()
    assert np.array_equal(np.sort(first, axis=None), (np.arange(SIZE**2) + 0.5) / SIZE**2)
    blue_noise.cache_clear()
    assert np.array_equal(blue_noise(), first)
    # Seen in the first version: a change shows in every dithered picture.
    assert (first[0, :4] * SIZE**2).astype(int).tolist() == FIRST_RANKS


FIRST_RANKS = [224, 1571, 1974, 52]


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_strips_and_threads_make_no_difference(tone: str, dither: bool) -> None:
    def side_by_side(jobs: list) -> None:
        threads = [Thread(target=job) for job in jobs]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    whole = developed(PICTURE, tone, dither)
    pixels = np.zeros_like(whole)
    develop(PICTURE, pixels, tone, dither, side_by_side, 3)
    assert np.array_equal(pixels, whole)
    alone = np.vstack([developed(np.ascontiguousarray(PICTURE[:64]), tone, dither), whole[64:]])
    assert np.array_equal(alone, whole)


def test_pixels_without_light_stay_as_they_are() -> None:
    light = PICTURE.copy()
    light[3:50:2, 5] = np.nan
    light[60] = np.nan
    pixels = np.full((*light.shape[:2], 4), 7, np.uint8)
    develop(light, pixels, "srgb")
    unknown = np.isnan(light[..., 0])
    assert (pixels[unknown] == 7).all()
    assert np.array_equal(pixels[~unknown], developed(PICTURE, "srgb", dither=False)[~unknown])


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_the_error_of_the_levels_is_the_one_that_is_stated(tone: str, dither: bool) -> None:
    light = RANDOM.random((200, 200, 3)) ** 2
    pixels = developed(light, tone, dither)
    shown = np.minimum(tone_named(tone).light, 1.0)[pixels[..., 2::-1]]
    assert rounding_error(pixels, tone, dither) == pytest.approx(np.sqrt(np.square(shown - light).mean()), rel=0.05)


def test_clipped_pixels_have_a_channel_above_the_highest_level() -> None:
    light = np.array([[[0.2, 1.0, 0], [0.2, 1 + 1e-12, 0], [0, 0, 1.001], [9, 9, 9], [0, 5, 0]]])
    assert [clipped_pixels(light, tone) for tone in ("plain", "srgb", "filmic")] == [3, 3, 1]


def test_steps_count_as_a_binary_search_does() -> None:
    for thresholds in (tone_named("srgb").halfway, tone_named("filmic").light[1:], np.array([0.25, 1.0])):
        near = np.concatenate([np.nextafter(thresholds, 0), thresholds, np.nextafter(thresholds, 9)])
        numbers = np.concatenate([near, [0.0, 1e-320, 1e9, np.inf], RANDOM.random(1000) * 9])
        assert np.array_equal(Steps(thresholds).count(numbers), np.searchsorted(thresholds, numbers, "right"))

"""Tone curves, compared with formulas that are written down here independently, forwards."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.rendering.outcome import ROUNDING, Outcome
from minirt.rendering.queries.preview import render_interpreted
from minirt.rendering.renderer import Renderer
from minirt.rendering.sampling.packets import estimated_error
from minirt.rendering.tone_mapping import NOISE, blue_noise, clipped_pixels, map_tones, rounding_error, tone_named
from minirt.scene import Background, Scene, parse
from minirt.scene.elements import TONES
from minirt.viewer.app.replay import replay
from tests.compare import assert_alike, off
from tests.kernel.pictures import ALL, TWO, linear
from tests.paths import ROOT, SCENES
from tests.reference import render, to_bytes

LIGHT = np.concatenate([[0.0, 1e-300, 1e300], np.linspace(0, 1.2, 60_001), np.geomspace(1e-6, 50, 40_001)])


def encode(light: float) -> float:
    """The transfer function of sRGB, IEC 61966-2-1:1999, 5.2."""
    return 12.92 * light if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055


def narkowicz(light: float) -> float:
    """The curve that Narkowicz published in 2015."""
    return light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14) if light < 1e9 else 1.0


CURVES = {"plain": lambda light: light, "srgb": encode, "filmic": lambda light: encode(min(narkowicz(light), 1.0))}


def levels(light: np.ndarray, tone: str, dither: bool = False) -> np.ndarray:
    """The levels of grey light."""
    pixels = np.zeros((*light.shape, 4), np.uint8)
    map_tones(np.repeat(light[..., None], 3, axis=-1), pixels, tone, dither)
    assert (pixels[..., 3] == 255).all()
    assert (pixels[..., :1] == pixels[..., :3]).all()
    return pixels[..., 0]


@pytest.mark.parametrize("tone", TONES)
def test_levels_are_the_nearest_on_the_curve(tone: str) -> None:
    exact = np.array([255 * min(CURVES[tone](light), 1.0) for light in LIGHT.tolist()])
    made = levels(LIGHT[None], tone)[0]
    assert np.abs(made - exact).max() <= 0.5 + 1e-9
    assert (made == np.floor(exact + 0.5)).mean() > 0.9999  # others lie half-way but for rounding
    halfway = tone_named(tone).halfway
    assert np.array_equal(levels(np.stack([halfway, np.nextafter(halfway, 0)]), tone), [range(1, 256), range(255)])


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_all_levels_come_back_from_the_light_that_they_stand_for(tone: str, dither: bool) -> None:
    light = tone_named(tone).light
    assert [255 * CURVES[tone](each) for each in light.tolist()] == pytest.approx(range(256), abs=1e-9)
    assert (levels(np.tile(light, (70, 1)), tone, dither) == np.arange(256)).all()


# Dithering keeps the mean, strips and parts make no difference, the stated error of levels is true.


RANDOM = np.random.default_rng(17)
PICTURE = RANDOM.random((77, 93, 3)) * 1.3


def mapped(light: np.ndarray, tone: str, dither: bool) -> np.ndarray:
    """The pixels of a picture."""
    pixels = np.zeros((*light.shape[:2], 4), np.uint8)
    map_tones(light, pixels, tone, dither)
    return pixels


@pytest.mark.parametrize("tone", TONES)
def test_dithering_keeps_the_mean_light_of_even_areas(tone: str) -> None:
    light = tone_named(tone).light
    for flat in [*RANDOM.uniform(0, light[-1], 40), *RANDOM.uniform(0, light[3], 10)]:
        made = levels(np.full((NOISE, NOISE), flat), tone, dither=True)
        above = int(np.searchsorted(light, flat))
        assert set(np.unique(made)) <= {above - 1, above}  # no worse than one level
        assert abs(light[made].mean() - flat) <= (light[above] - light[above - 1]) / NOISE**2


def test_dithering_has_no_low_frequencies_and_no_seam() -> None:
    spectrum = np.abs(np.fft.fft2(blue_noise() - 0.5)) ** 2  # of the endlessly repeated square
    low = np.minimum(np.arange(NOISE), NOISE - np.arange(NOISE))
    distance = np.hypot(*np.meshgrid(low, low))
    assert spectrum[(distance > 0) & (distance < NOISE / 8)].mean() < 0.01 * spectrum[distance > NOISE / 4].mean()


def test_the_thresholds_are_all_different_and_the_same_at_each_start() -> None:
    first = blue_noise()
    assert np.array_equal(np.sort(first, axis=None), (np.arange(NOISE**2) + 0.5) / NOISE**2)
    blue_noise.cache_clear()
    assert np.array_equal(blue_noise(), first)
    # Seen in the first version: a change shows in every dithered picture.
    assert (first[0, :4] * NOISE**2).astype(int).tolist() == FIRST_RANKS


FIRST_RANKS = [224, 1571, 1974, 52]


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_strips_and_parts_make_no_difference(tone: str, dither: bool) -> None:
    whole = mapped(PICTURE, tone, dither)
    pixels = np.zeros_like(whole)
    map_tones(PICTURE, pixels, tone, dither, run=lambda job: [job() for _ in range(3)])
    assert np.array_equal(pixels, whole)
    alone = np.vstack([mapped(np.ascontiguousarray(PICTURE[:64]), tone, dither), whole[64:]])
    assert np.array_equal(alone, whole)


def test_a_picture_that_is_not_wanted_any_more_is_not_mapped() -> None:
    answers = iter([True, False])
    whole, pixels = mapped(PICTURE, "srgb", False), np.zeros((*PICTURE.shape[:2], 4), np.uint8)
    map_tones(PICTURE, pixels, "srgb", is_wanted=lambda: next(answers))
    drawn = (pixels == whole).all(axis=(1, 2))
    assert drawn[0]
    assert not pixels[~drawn].any()
    assert not drawn.all()


def test_pixels_without_light_stay_as_they_are() -> None:
    light = PICTURE.copy()
    light[3:50:2, 5] = np.nan
    light[60] = np.nan
    pixels = np.full((*light.shape[:2], 4), 7, np.uint8)
    map_tones(light, pixels, "srgb")
    unknown = np.isnan(light[..., 0])
    assert (pixels[unknown] == 7).all()
    assert np.array_equal(pixels[~unknown], mapped(PICTURE, "srgb", dither=False)[~unknown])


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_the_error_of_the_levels_is_the_one_that_is_stated(tone: str, dither: bool) -> None:
    light = RANDOM.random((200, 200, 3)) ** 2
    pixels = mapped(light, tone, dither)
    shown = np.minimum(tone_named(tone).light, 1.0)[pixels[..., 2::-1]]
    assert rounding_error(pixels, tone, dither) == pytest.approx(np.sqrt(np.square(shown - light).mean()), rel=0.05)


def test_clipped_pixels_have_a_channel_above_the_highest_level() -> None:
    light = np.array([[[0.2, 1.0, 0], [0.2, 1 + 1e-12, 0], [0, 0, 1.001], [9, 9, 9], [0, 5, 0]]])
    assert [clipped_pixels(light, tone) for tone in ("plain", "srgb", "filmic")] == [3, 3, 1]


# Toned, exposed and dithered pictures of whole scenes, compared with the reference renderer and with each other.


WIDTH, HEIGHT = 96, 54
DITHERED = Renderer(2, dither=True)
HELD_OUT = f"""A 0.1 120,180,255
C 0.5,1.5,-7 -0.1,-0.1,1 55 roll:7 tone:TONE exposure:EV
bg {SCENES}/textures/evening.png
L -4,6,-5 0.8 255,220,170
sl 4,5,-3 -0.6,-0.7,0.4 50 0.7 120,200,90
dl 0.3,-1,0.5 0.3 255,255,200
pl 0,-1,0 0,1,0 200,180,150 checker:1.3,40,90,60
sp -1.2,0.2,0 2 128,64,32 mirror:0.3 specular:0.7,60
sp 1.4,0,0.5 2 255,255,255 texture:{SCENES}/textures/bricks.png normal:{SCENES}/textures/bricks-normal.png
cy 0,-0.6,-2 1,0.3,0.1 0.5 1.5 64,128,192 bump:{SCENES}/textures/planet-height.png,0.05
"""


def held_out(tone: str, exposure: float = 0.0) -> Scene:
    """A scene with all kinds of lights, and colours in all places that hold one."""
    return parse(HELD_OUT.replace("TONE", tone).replace("EV", str(exposure))).scene


def toned(scene: Scene, tone: str, exposure: float = 0.0) -> Scene:
    """A scene in another tone."""
    return scene.replace(scene.camera, tone=tone, exposure=exposure)


def pixels_of(scene: Scene, renderer: Renderer = TWO, samples: int = 1) -> NDArray[np.uint8]:
    """The pixels of a picture."""
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert renderer.render(scene, pixels, samples)
    return pixels


@pytest.mark.parametrize(("tone", "exposure"), [("plain", 1.5), ("srgb", 0.0), ("srgb", -0.7), ("filmic", 2.3)])
def test_a_held_out_scene_equals_the_reference(tone: str, exposure: float) -> None:
    scene = held_out(tone, exposure)
    expected = to_bytes(render(scene, WIDTH, HEIGHT), tone)
    made = np.ascontiguousarray(pixels_of(scene)[..., 2::-1])
    assert_alike(f"tone-{tone}", made, expected, share=4e-3)
    others = [held_out("plain"), held_out(tone, exposure + 0.1), held_out("srgb" if tone == "filmic" else "filmic")]
    assert all(off(pixels_of(other)[..., 2::-1], expected).mean() > 0.2 for other in others if other != scene)


@pytest.mark.parametrize("tone", ["plain", "srgb"])
def test_one_more_ev_doubles_the_light_to_the_bit(tone: str) -> None:
    lights = [linear(held_out(tone, exposure), 64, 36, 2) for exposure in (-3, 0, 1, 12)]
    for light, factor in zip(lights, (1 / 8, 1, 2, 4096), strict=True):
        assert np.array_equal(light, factor * lights[1])


@pytest.mark.parametrize("dither", [False, True])
@pytest.mark.parametrize("tone", TONES)
def test_files_windows_and_refined_pictures_agree(tone: str, dither: bool) -> None:
    scene, renderer = toned(ALL, tone, 0.5), DITHERED if dither else TWO
    expected = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    map_tones(linear(scene, WIDTH, HEIGHT), expected, tone, dither)
    assert np.array_equal(pixels_of(scene, renderer), expected)
    size = (WIDTH, HEIGHT)
    shown = replay(scene, [], renderer=renderer, size=size, path="scene.rt", samples=1, hud=False)
    assert np.array_equal(shown, expected)
    light, refined, alone = linear(scene, WIDTH, HEIGHT), expected.copy(), expected.copy()
    assert renderer.render(scene, refined, 16, linear=light, edges_only=True)
    assert renderer.render(scene, alone, 16, edges_only=True)
    map_tones(light, expected, tone, dither)
    assert np.array_equal(refined, expected)
    assert np.array_equal(alone, expected)
    assert not np.array_equal(alone, pixels_of(scene, renderer))


def test_a_preview_has_the_tone() -> None:
    scene = toned(ALL, "srgb")
    pixels, light = render_interpreted(scene, 24, 16)
    expected = np.zeros_like(pixels)
    map_tones(light, expected, "srgb")
    assert np.array_equal(pixels, expected)


@pytest.mark.parametrize("paint", [None, (40, 90, 200), str(ROOT / "scenes/textures/evening.png")])
def test_scenes_without_shapes_have_a_tone(paint: tuple[int, int, int] | str | None) -> None:
    background = (Background(paint),) if paint else ()
    scene = Scene((ALL.camera.replace(tone="srgb", exposure=0.3), *background))
    expected = to_bytes(render(scene, WIDTH, HEIGHT), "srgb")
    assert np.abs(pixels_of(scene)[..., 2::-1].astype(int) - expected).max() <= 1
    assert np.abs(pixels_of(scene, DITHERED)[..., 2::-1].astype(int) - expected).max() <= 1


def reach(scene: Scene, renderer: Renderer, error: float) -> tuple[Outcome, NDArray[np.uint8]]:
    """A picture that is drawn to an error, without its light."""
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    outcome = renderer.reach(scene, pixels, error)
    assert outcome
    return outcome, pixels


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("dither", [False, True])
def test_errors_are_those_of_light_and_of_the_levels_that_stand_for_it(tone: str, dither: bool) -> None:
    scene, renderer = toned(ALL, tone, 0.4), DITHERED if dither else TWO
    truth = np.minimum(linear(scene, WIDTH, HEIGHT, 1500), 1.0)
    for error in (0.01, 0.004):
        outcome, pixels = reach(scene, renderer, error)
        assert outcome.error <= error
        shown = np.minimum(tone_named(tone).light, 1.0)[pixels[..., 2::-1]]
        true = np.sqrt(np.square(shown - truth).mean())
        assert 1 / 1.5 < outcome.error_of_bytes / true < 2.5  # in doubt the estimate is too large
        assert outcome.rounding > 0


@pytest.mark.parametrize("tone", TONES)
def test_dithering_makes_rounding_decide_sooner(tone: str) -> None:
    rounded, _ = reach(toned(ALL, tone), TWO, 1e-9)
    dithered, _ = reach(toned(ALL, tone), DITHERED, 1e-9)
    for outcome in (rounded, dithered):
        assert outcome.rounded
        assert outcome.error <= 0.51 * outcome.rounding
        assert f"below an error of {outcome.rounding / 2:.2g}" in outcome.notice
    assert dithered.rounding == pytest.approx(2**0.5 * rounded.rounding, rel=0.03)
    assert tone != "plain" or rounded.rounding == ROUNDING


def test_the_estimate_of_the_window_is_that_of_light() -> None:
    scene = toned(ALL, "srgb")
    before = pixels_of(scene)
    after = before.copy()
    assert TWO.render(scene, after, 16, edges_only=True)
    truth = np.minimum(linear(scene, WIDTH, HEIGHT, 1500), 1.0)
    true = np.sqrt(np.square(tone_named("srgb").light[after[..., 2::-1]] - truth).mean())
    estimate = estimated_error(before, after, 1, 16, tone="srgb")
    assert estimate is not None
    assert 1 / 1.5 < estimate / true < 1.5


def test_a_changed_tone_is_packed_anew() -> None:
    scene = held_out("plain")
    first = pixels_of(scene)
    for tone in ("srgb", "plain", "filmic", "plain"):
        again = pixels_of(held_out(tone), TWO)
        assert np.array_equal(again, pixels_of(held_out(tone), Renderer(1)))
    assert np.array_equal(again, first)

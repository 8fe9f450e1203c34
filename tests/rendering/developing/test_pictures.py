"""Toned, exposed and dithered pictures of whole scenes, compared with the reference renderer and with each other."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.rendering import Renderer, darkroom
from minirt.rendering.developing.develop import develop
from minirt.rendering.developing.tone import tone_named
from minirt.rendering.queries.preview import render_interpreted
from minirt.rendering.sampling.error_estimate import estimated_error
from minirt.rendering.sampling.outcome import ROUNDING, Outcome
from minirt.scene import Background, Scene, parse
from minirt.scene.elements import TONES
from minirt.viewer import replay
from tests.compare import assert_alike, off
from tests.kernel.pictures import ALL, TWO, linear
from tests.paths import ROOT, SCENES
from tests.reference import render, to_bytes

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


def levels(scene: Scene, renderer: Renderer = TWO, samples: int = 1) -> NDArray[np.uint8]:
    """The pixels of a picture."""
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    assert renderer.render(scene, pixels, samples)
    return pixels


@pytest.mark.parametrize(("tone", "exposure"), [("plain", 1.5), ("srgb", 0.0), ("srgb", -0.7), ("filmic", 2.3)])
def test_a_held_out_scene_equals_the_reference(tone: str, exposure: float) -> None:
    scene = held_out(tone, exposure)
    expected = to_bytes(render(scene, WIDTH, HEIGHT), tone)
    made = np.ascontiguousarray(levels(scene)[..., 2::-1])
    assert_alike(f"tone-{tone}", made, expected, share=4e-3)
    others = [held_out("plain"), held_out(tone, exposure + 0.1), held_out("srgb" if tone == "filmic" else "filmic")]
    assert all(off(levels(other)[..., 2::-1], expected).mean() > 0.2 for other in others if other != scene)


@pytest.mark.parametrize("tone", ["plain", "srgb"])
def test_one_more_ev_doubles_the_light_to_the_bit(tone: str) -> None:
    lights = [linear(held_out(tone, exposure), 64, 36, 2) for exposure in (-3, 0, 1, 12)]
    for light, factor in zip(lights, (1 / 8, 1, 2, 4096), strict=True):
        assert np.array_equal(light, factor * lights[1])


def test_the_default_is_plain_and_has_the_bits_of_the_kernel() -> None:
    light = linear(ALL, WIDTH, HEIGHT)
    assert np.array_equal(levels(ALL)[..., 2::-1], np.floor(np.minimum(light, 1) * 255 + 0.5).astype(np.uint8))
    assert TWO.darkroom.light_for(ALL, np.zeros((4, 4, 4), np.uint8), None).size == 0
    assert DITHERED.darkroom.light_for(ALL, np.zeros((4, 4, 4), np.uint8), None).size == 48


def test_the_light_of_a_toned_picture_is_not_kept_beside_plain_ones() -> None:
    renderer = Renderer(1)
    for tone, size in (("srgb", 3 * WIDTH * HEIGHT), ("plain", 0)):
        levels(toned(ALL, tone), renderer)
        assert renderer.darkroom.scratch.size == size


@pytest.mark.parametrize("dither", [False, True])
@pytest.mark.parametrize("tone", TONES)
def test_files_windows_and_refined_pictures_agree(tone: str, dither: bool) -> None:
    scene, renderer = toned(ALL, tone, 0.5), DITHERED if dither else TWO
    expected = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    develop(linear(scene, WIDTH, HEIGHT), expected, tone, dither)
    assert np.array_equal(levels(scene, renderer), expected)
    size = (WIDTH, HEIGHT)
    shown = replay(scene, [], renderer=renderer, size=size, path="scene.rt", samples=1, hud=False)
    assert np.array_equal(shown, expected)
    light, refined, alone = linear(scene, WIDTH, HEIGHT), expected.copy(), expected.copy()
    assert renderer.refine(scene, refined, 16, linear=light)
    assert renderer.refine(scene, alone, 16)
    develop(light, expected, tone, dither)
    assert np.array_equal(refined, expected)
    assert np.array_equal(alone, expected)
    assert not np.array_equal(alone, levels(scene, renderer))


def test_a_preview_has_the_tone() -> None:
    scene = toned(ALL, "srgb")
    pixels, light = render_interpreted(scene, 24, 16)
    expected = np.zeros_like(pixels)
    develop(light, expected, "srgb")
    assert np.array_equal(pixels, expected)


@pytest.mark.parametrize("paint", [None, (40, 90, 200), str(ROOT / "scenes/textures/evening.png")])
def test_scenes_without_shapes_have_a_tone(paint: tuple[int, int, int] | str | None) -> None:
    background = (Background(paint),) if paint else ()
    scene = Scene((ALL.camera.replace(tone="srgb", exposure=0.3), *background))
    expected = to_bytes(render(scene, WIDTH, HEIGHT), "srgb")
    assert np.abs(levels(scene)[..., 2::-1].astype(int) - expected).max() <= 1
    assert np.abs(levels(scene, DITHERED)[..., 2::-1].astype(int) - expected).max() <= 1


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
        assert 1 / 1.5 < outcome.error_of_bytes / true < 1.5
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
    assert max(rounded.rounding, dithered.rounding) < darkroom.LARGEST_FLOOR


def test_the_estimate_of_the_window_is_that_of_light() -> None:
    scene = toned(ALL, "srgb")
    before = levels(scene)
    after = before.copy()
    assert TWO.refine(scene, after, 16)
    truth = np.minimum(linear(scene, WIDTH, HEIGHT, 1500), 1.0)
    true = np.sqrt(np.square(tone_named("srgb").light[after[..., 2::-1]] - truth).mean())
    estimate = estimated_error(before, after, 1, 16, tone="srgb")
    assert estimate is not None
    assert 1 / 1.5 < estimate / true < 1.5


def test_a_changed_tone_is_packed_anew() -> None:
    scene = held_out("plain")
    first = levels(scene)
    for tone in ("srgb", "plain", "filmic", "plain"):
        again = levels(held_out(tone), TWO)
        assert np.array_equal(again, levels(held_out(tone), Renderer(1)))
    assert np.array_equal(again, first)

"""Outline, axis and icons: where they are, and that the picture stays as it is."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.rendering.queries.pick import covers
from minirt.scene import Camera
from minirt.shapes import KINDS, Shape
from minirt.viewer.display.icons import icons, signed
from minirt.viewer.display.marks import AXES, GOLD, blue_first, draw_line
from minirt.viewer.display.outline import rims
from minirt.viewer.display.overlay import letters
from minirt.viewer.display.painter import paint
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import Frame
from tests.random_scenes import random_scene
from tests.viewer.app.test_session import Bench
from tests.viewer.fake import TEXT, colour_of, played

WIDTH, HEIGHT = 160, 90
GOLDEN = np.array(blue_first(GOLD), np.uint8)


def edges(shape: Shape, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """The pixels outside and inside, of which a neighbour is on the other side: by all pixels of the picture."""
    mask = covers(shape, camera, WIDTH, HEIGHT, *np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT)))
    framed = np.pad(mask, 1, mode="edge")
    around = framed[:-2, 1:-1], framed[2:, 1:-1], framed[1:-1, :-2], framed[1:-1, 2:]
    return np.logical_or.reduce(around) & ~mask, mask & ~np.logical_and.reduce(around)


def drawn(places: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    mask = np.zeros((HEIGHT, WIDTH), bool)
    mask[places] = True
    return mask


@pytest.mark.parametrize("seed", range(8))
def test_an_outline_is_where_the_shape_ends(seed: int) -> None:
    made = random_scene(seed)
    for shape in made.shapes:
        for found, known in zip(rims(shape, made.camera, WIDTH, HEIGHT, 10**6), edges(shape, made.camera), strict=True):
            assert np.array_equal(drawn(found), known)


def test_few_rays_find_most_of_it() -> None:
    known = found = 0
    for seed in range(8):
        made = random_scene(seed)
        for shape in made.shapes:
            outside, _ = edges(shape, made.camera)
            known += outside.sum()
            found += (drawn(rims(shape, made.camera, WIDTH, HEIGHT, 300)[0]) & outside).sum()
    assert found > 0.9 * known > 0


def test_the_random_scenes_have_every_kind_of_old() -> None:
    kinds = {type(shape) for seed in range(8) for shape in random_scene(seed).shapes}
    assert len(kinds) >= 3
    assert kinds <= {kind.element for kind in KINDS}


def golden(session) -> np.ndarray:
    return (session.screen.frame == GOLDEN).all(axis=2)


def test_the_selected_shape_has_an_outline_and_the_picture_has_none() -> None:
    session = played("resize 160x90", "click 82,44")
    assert session.state.element.title == "sphere"
    outside, _ = edges(session.state.element, session.state.scene.camera)
    assert golden(session)[outside][40:].all()  # but where the line of information is
    assert (session.picture == colour_of(session.state.scene)).all()
    assert not golden(played("resize 160x90", "click 82,44", "press C")).any()
    assert not golden(played("resize 160x90", "click 82,44", "press I", "press I")).any()


def test_the_outline_is_that_of_the_picture_while_another_is_on_its_way() -> None:
    bench = Bench()
    bench.session.pick = lambda scene, *_: scene.spheres[0]
    bench.finish(0.001)
    bench.memory.click(33, 23)
    bench.memory.play()
    before = bench.memory.screenshot()
    bench.memory.text("+")
    bench.memory.play()
    assert np.array_equal(bench.memory.screenshot(), before)
    bench.finish(0.001)
    assert not np.array_equal(bench.memory.screenshot(), before)


def test_the_outline_is_that_of_the_picture_when_an_older_one_comes() -> None:
    bench = Bench()
    bench.session.pick = lambda scene, *_: scene.spheres[0]
    bench.finish(0.001)
    bench.memory.resize(WIDTH, HEIGHT)
    bench.memory.click(80, 45)
    bench.memory.text("+")
    bench.memory.play()
    (older,) = bench.painter.open
    bench.memory.text("+" * 9)
    bench.memory.play()
    bench.painter.outcomes.append(paint(bench.painter.renderer, older))
    bench.painter.notify()
    bench.memory.play()
    assert bench.session.pictures.latest.job is older
    assert bench.session.state.scene is not older.scene
    outside, _ = edges(older.scene.spheres[0], older.scene.camera)
    assert golden(bench.session)[outside][40:].all()


@pytest.mark.parametrize(("presses", "frame"), [(1, Frame.X), (2, Frame.Y), (3, Frame.Z)])
def test_the_axis_goes_through_the_element(presses: int, frame: Frame) -> None:
    text = "A 0 0,0,0\nC 5,4,10 -0.5,-0.4,-1 60\nsp 0,0,0 0.1 9,9,9\n"
    session = played("resize 160x120", "press Tab", *["press X"] * presses, text=text)
    coloured = (session.screen.frame == np.array(blue_first(AXES[frame]), np.uint8)).all(axis=2)
    seen = projection_of(session.state.scene.camera, 160, 120)
    ends = [(reach * (frame is Frame.X), reach * (frame is Frame.Y), reach * (frame is Frame.Z)) for reach in (-1, 1)]
    for point in ends:
        x, y = seen.pixel(point)
        assert coloured[round(y) - 2 : round(y) + 3, round(x) - 2 : round(x) + 3].any()
    camera = played("resize 160x120", *["press X"] * presses, text=text).screen.frame
    assert not (camera == np.array(blue_first(AXES[frame]), np.uint8)).all(axis=2).any()


@pytest.mark.parametrize(
    ("start", "end", "some"),
    [((5, 5), (50, 30), True), ((-1e6, 20), (1e6, 20), True), ((20, -1e9), (20, 1e9), True), ((-9, -9), (-3, 9), False),
     ((70, 5), (99, 5), False), ((-1e5, -1e5), (1e5, 1e5), True)],
)  # fmt: skip
def test_lines_end_at_the_border(start, end, some) -> None:
    pixels = np.zeros((40, 60, 4), np.uint8)
    draw_line(pixels, start, end, 0xFFFFFF)
    assert pixels.any() == some


def test_lights_have_icons_that_can_be_clicked() -> None:
    text = TEXT.replace("L 5,5,5", "L 2,2,5")
    hidden, shown = played("resize 300x200", text=text), played("resize 300x200", "press G", text=text)
    assert not np.array_equal(hidden.screen.frame, shown.screen.frame)
    state = shown.state
    placed = icons(state.scene, signed(state.scene), projection_of(state.scene.camera, 300, 200), 1.0)
    assert sorted(icon.code for icon in placed) == ["A", "C", "L"]
    for icon in placed:
        keys = ["resize 300x200", "press Tab", "press Tab", "press G", f"click {icon.x},{icon.y}"]
        clicked = played(*keys, text=text).state
        assert clicked.element.code == icon.code
    (lamp,) = [icon for icon in placed if icon.code == "L"]
    assert played("resize 300x200", f"click {lamp.x},{lamp.y}", text=text).state.element.code != "L"
    drag = f"drag {lamp.x},{lamp.y} {lamp.x - 20},{lamp.y}"
    moved = played("resize 300x200", "press G", drag, text=text).state.scene
    seen = projection_of(moved.camera, 300, 200)
    assert seen.pixel(moved.lights[0].position) == pytest.approx((lamp.x - 20, lamp.y), abs=1)


def test_letters_fit_the_window_and_the_screen() -> None:
    assert letters(1280, 720, 1.0) == 16
    assert letters(2560, 1440, 2.0) == 32
    assert letters(200, 120, 1.0) < 12
    assert letters(1, 1, 3.0) == 8

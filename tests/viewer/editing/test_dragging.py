"""The pointer with a button held: what is under it stays there, and a drag is one thing to undo."""

from __future__ import annotations

from math import acos, degrees, dist

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.mlx import Key
from minirt.rendering.queries.pick import surface_point
from minirt.scene import Camera
from minirt.viewer.editing.measure import middle_of
from minirt.viewer.editing.projection import dot, projection
from tests.viewer.fake import played, scene
from tests.viewer.session_harness import SessionHarness

WIDTH, HEIGHT = 64, 48
FROM, TO = (33, 23), (45, 15)  # on the sphere; beside it
DRAG = "drag 33,23 45,15"
SEEN = projection(scene().camera, WIDTH, HEIGHT)
HALF = 0.5  # the middle of a pixel

numbers = st.floats(-1, 1, allow_nan=False)


@given(numbers, numbers, st.floats(0.01, 1), st.floats(1, 150), st.floats(-180, 180), st.tuples(numbers, numbers))
def test_places_and_pixels_are_each_others_inverse(x, y, z, fov, roll, at):
    seen = projection(Camera((x, y, z), (x, y, z), fov, roll), 640, 360)
    pixel = 640 * (at[0] + 1) / 2, 360 * (at[1] + 1) / 2
    point = seen.at_depth(*pixel, 7.0)
    assert seen.depth(point) == pytest.approx(7)
    assert seen.pixel(point) == pytest.approx(pixel, abs=1e-6)
    assert seen.pixel(seen.at_depth(*pixel, -7.0)) is None


def held(shape, x, y):
    """The place on a shape under a pixel."""
    return surface_point(shape, scene().camera, WIDTH, HEIGHT, x, y)


def test_what_is_under_the_pointer_stays_there():
    session = played(DRAG)
    (old,), (new,) = scene().spheres, session.state.scene.spheres
    assert session.state.element is new
    way = [b - a for a, b in zip(old.centre, new.centre, strict=True)]
    assert dot(way, SEEN.forward) == pytest.approx(0, abs=1e-9)
    moved = tuple(a + b for a, b in zip(held(old, *FROM), way, strict=True))
    assert SEEN.pixel(moved) == pytest.approx([each + HALF for each in TO], abs=1e-3)


@pytest.mark.parametrize(("presses", "axis"), [(1, 0), (2, 1), (3, 2)])
def test_along_an_axis_nothing_else_changes(presses, axis):
    text = "A 0 0,0,0\nC 5,4,10 -0.5,-0.4,-1 60\nsp 0,0,0 2 9,9,9\n"
    session = played(*["press X"] * presses, "drag 32,24 40,20", text=text)
    centre = session.state.scene.spheres[0].centre
    assert [i for i in range(3) if centre[i] != 0] == [axis]
    # No other place of the axis is nearer to the pointer's ray.
    seen = projection(session.state.scene.camera, WIDTH, HEIGHT)
    (ball,) = scene(text).spheres
    start = surface_point(ball, scene(text).camera, WIDTH, HEIGHT, 32, 24)

    def distance(step):
        point = [a + (centre[axis] + step) * (i == axis) for i, a in enumerate(start)]
        way = [a - b for a, b in zip(point, seen.eye, strict=True)]
        along = dot(way, seen.ray(40.5, 20.5))
        return dist(way, [along * each for each in seen.ray(40.5, 20.5)])

    assert distance(0) < min(distance(0.02), distance(-0.02))


def test_a_drag_on_nothing_looks_around():
    session = played("press Tab", "press Tab", "drag 5,3 20,12")
    assert session.state.element.title == "sphere"
    assert session.state.scene.spheres == scene().spheres
    camera = session.state.scene.camera
    assert camera.position == scene().camera.position
    assert degrees(acos(-camera.direction[2])) == pytest.approx(90 * 17.5 / 64, rel=0.02)  # far things follow
    assert camera.direction[0] < 0 < camera.direction[1]


def test_with_shift_it_turns():
    session = played("down Shift", "drag 41,24 53,24", "up Shift")  # the cylinder, about the view's up: its own axis
    assert session.state.element.title == "cylinder"
    assert session.state.scene.cylinders == scene().cylinders
    session = played("down Shift", "drag 41,24 41,36", "up Shift")  # down by a quarter of the shorter side: 45 degrees
    axis = session.state.element.axis
    assert axis == pytest.approx((0, 0.5**0.5, 0.5**0.5))
    about_x = played("press X", "down Shift", "drag 41,24 53,24", "up Shift").state.element.axis
    assert about_x == pytest.approx((0, 0.5**0.5, 0.5**0.5))
    assert "same from all sides" in played("down Shift", DRAG, "up Shift").state.message


@pytest.mark.parametrize("lines", [(), ("click 33,23",), ("press Tab",), ("press Ctrl+D",)])
def test_the_camera_goes_round_what_is_selected(lines):
    before = played(*lines)
    after = played(*lines, "drag 10,10 22,16 right")
    state = before.state
    pivot = {"sphere": (0, 0, 0), "light": (5, 5, 5)}.get(state.element.title, middle_of(state.scene))
    old, new = state.scene.camera, after.state.scene.camera
    assert new != old
    assert dist(new.position, pivot) == pytest.approx(dist(old.position, pivot), rel=1e-5)
    pixels = [projection(camera, WIDTH, HEIGHT).pixel(pivot) for camera in (old, new)]
    assert pixels[0] == pytest.approx(pixels[1], abs=1e-3)
    assert after.state.element.title == state.element.title


def test_going_round_stops_above():
    camera = played("drag 10,0 10,47 right").state.scene.camera
    assert camera.direction[1] == pytest.approx(-1)


def test_the_camera_slides():
    session = played("drag 33,23 45,15 middle")
    camera = session.state.scene.camera
    point = held(scene().spheres[0], *FROM)
    assert projection(camera, WIDTH, HEIGHT).pixel(point) == pytest.approx([each + HALF for each in TO], abs=1e-3)
    assert camera.direction == scene().camera.direction
    assert played("drag 5,3 9,3 middle").state.scene.camera.position[0] < 0


class TestUndo:
    @pytest.mark.parametrize("line", [DRAG, f"{DRAG} right", f"{DRAG} middle", "drag 5,3 20,12"])
    def test_a_drag_is_one_thing(self, line):
        session = played(line)
        assert len(session.state.past) == 1
        assert played(line, "press Ctrl+Z").state.scene.items == scene().items
        assert played(line, "press Ctrl+Z", "press Ctrl+Y").state.scene.items == session.state.scene.items

    def test_two_drags_are_two(self):
        assert len(played(DRAG, "drag 45,15 33,23").state.past) == 2
        assert len(played("press Tab", "press Tab", "press d", DRAG, "press d").state.past) == 3

    def test_whatever_the_way(self):
        there_and_back = played("drag 33,23 60,40", "press Ctrl+Z", DRAG)
        assert there_and_back.state.scene.items == played(DRAG).state.scene.items

    def test_a_pause_is_no_end(self):
        bench = dragging()
        bench.memory.wait(3)
        bench.memory.motion(*TO)
        bench.memory.play()
        assert len(bench.session.state.past) == 1


def dragging() -> SessionHarness:
    """Half way through a drag of the sphere."""
    bench = SessionHarness()
    bench.session.pick = lambda scene, *_: scene.spheres[0]
    bench.memory.button_press(1, *FROM)
    bench.memory.motion(40, 20)
    bench.memory.play()
    assert len(bench.session.state.past) == 1
    return bench


@pytest.mark.parametrize(
    "end",
    [
        lambda memory: memory.button_release(1, 40, 20),
        lambda memory: memory.focus(False),
        lambda memory: memory.resize(80, 60),
        lambda memory: memory.tap(Key.CONTROL_L, Key.Z),
        lambda memory: memory.tap(Key.DELETE),
        lambda memory: memory.button_press(3, 1, 1),
    ],
)
def test_what_ends_a_drag(end):
    bench = dragging()
    end(bench.memory)
    bench.memory.play()
    after = bench.session.state.scene
    bench.memory.motion(*TO)
    bench.memory.play()
    assert bench.session.state.scene is after or bench.session.pressed


def test_a_click_moves_nothing_although_the_hand_trembles():
    bench = SessionHarness()
    bench.session.pick = lambda scene, *_: scene.spheres[0]
    bench.memory.button_press(1, *FROM)
    bench.memory.motion(FROM[0] + 3, FROM[1] - 3)
    bench.memory.button_release(1, FROM[0] + 3, FROM[1] - 3)
    bench.memory.play()
    assert bench.session.state.element.title == "sphere"
    assert bench.session.state.past == ()


def test_a_right_click_selects_the_camera_and_a_right_drag_does_not():
    assert played("click 33,23", "click 5,5 right").state.element.title == "camera"
    assert played("click 33,23", "drag 5,5 30,5 right").state.element.title == "sphere"

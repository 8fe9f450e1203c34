"""Drags of the pointer: the point under the pointer stays there, and a drag is one undo step."""

from __future__ import annotations

from math import acos, degrees, dist, hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.mlx import Key
from minirt.rendering.queries.pick import pick
from minirt.scene import Camera
from minirt.scene.elements import linear_combination
from minirt.viewer.editing.projection import dot, projection_of, scene_centre
from tests.viewer.fake import TEXT, played, scene
from tests.viewer.session_harness import SessionHarness

WIDTH, HEIGHT = 64, 48
FROM, TO = (33, 23), (45, 15)  # on the sphere; beside it
DRAG = "drag 33,23 45,15"
PROJECTION = projection_of(scene().camera, WIDTH, HEIGHT)
HALF = 0.5  # pixel: offset of its centre
STEP = 0.1  # of which a drag makes multiples in these small pictures, whose pixels are not much larger

numbers = st.floats(-1, 1, allow_nan=False)


@given(numbers, numbers, st.floats(0.01, 1), st.floats(1, 150), st.floats(-180, 180), st.tuples(numbers, numbers))
def test_projecting_to_pixels_and_back_is_the_identity(x, y, z, fov, roll, at):
    projection = projection_of(Camera((x, y, z), (x, y, z), fov, roll), 640, 360)
    pixel = 640 * (at[0] + 1) / 2, 360 * (at[1] + 1) / 2
    before, behind = (
        linear_combination(1.0, projection.eye, depth, projection.direction_through(*pixel)) for depth in (7.0, -7.0)
    )
    assert projection.depth(before) == pytest.approx(7)
    assert projection.pixel(before) == pytest.approx(pixel, abs=1e-6)
    assert projection.pixel(behind) is None


def test_the_point_under_the_pointer_stays_there():
    session = played(DRAG)
    (old,), (new,) = scene().spheres, session.state.scene.spheres
    assert session.state.element is new
    offset = [b - a for a, b in zip(old.centre, new.centre, strict=True)]
    assert dot(offset, PROJECTION.forward) == pytest.approx(0, abs=STEP)
    assert all(round(each, 2) == each for each in new.centre)
    moved = tuple(a + b for a, b in zip(pick(scene(), WIDTH, HEIGHT, *FROM)[1], offset, strict=True))
    assert PROJECTION.pixel(moved) == pytest.approx([each + HALF for each in TO], abs=HALF)


@pytest.mark.parametrize(("presses", "axis"), [(1, 0), (2, 1), (3, 2)])
def test_a_drag_along_an_axis_changes_one_coordinate(presses, axis):
    text = "A 0 0,0,0\nC 5,4,10 -0.5,-0.4,-1 60\nsp 0,0,0 2 9,9,9\n"
    session = played(*["press X"] * presses, "drag 32,24 40,20", text=text)
    centre = session.state.scene.spheres[0].centre
    assert [i for i in range(3) if centre[i] != 0] == [axis]
    # No other point of the axis is nearer to the pointer's ray.
    projection = projection_of(session.state.scene.camera, WIDTH, HEIGHT)
    _, start = pick(scene(text), WIDTH, HEIGHT, 32, 24)

    def distance(step):
        point = [a + (centre[axis] + step) * (i == axis) for i, a in enumerate(start)]
        offset = [a - b for a, b in zip(point, projection.eye, strict=True)]
        along = dot(offset, projection.ray(40.5, 20.5))
        return dist(offset, [along * each for each in projection.ray(40.5, 20.5)])

    assert distance(0) < min(distance(2 * STEP), distance(-2 * STEP))


def test_a_drag_on_nothing_looks_around():
    session = played("press Tab", "press Tab", "drag 5,3 20,12")
    assert session.state.element.title == "sphere"
    assert session.state.scene.spheres == scene().spheres
    camera = session.state.scene.camera
    assert camera.position == scene().camera.position
    assert degrees(acos(-camera.direction[2])) == pytest.approx(
        90 * 17.5 / 64, rel=0.02
    )  # distant objects follow the pointer
    assert camera.direction[0] < 0 < camera.direction[1]


def test_a_drag_with_shift_turns_the_element():
    session = played("down Shift", "drag 41,24 53,24", "up Shift")  # the cylinder, about the view's up: its own axis
    assert session.state.element.title == "cylinder"
    assert session.state.scene.cylinders == scene().cylinders
    session = played("down Shift", "drag 41,24 41,36", "up Shift")  # down by a quarter of the shorter side: 45 degrees
    axis = session.state.element.axis
    assert axis == pytest.approx((0, 0.5**0.5, 0.5**0.5))
    about_x = played("press X", "down Shift", "drag 41,24 53,24", "up Shift").state.element.axis
    assert about_x == pytest.approx((0, 0.5**0.5, 0.5**0.5))
    assert "same from all sides" in played("down Shift", DRAG, "up Shift").state.message


@pytest.mark.parametrize("chord", [("Alt",), ("Ctrl", "Shift")])
def test_a_drag_with_alt_slides_along_surfaces_and_turns_to_them(chord):
    text = "A 0 0,0,0\nC 0,0,10 0,0,-1 60\nsp 0,0,0 6 9,9,9\nco 0,0,4 0,0,-1 0.8 1 9,9,9\n"
    down, up = ([f"{way} {key}" for key in chord] for way in ("down", "up"))
    session = played(*down, "drag 32,24 42,24", *up, text=text)
    nose = session.state.element
    x, y, z = nose.apex
    assert hypot(x, y, z) == pytest.approx(4, abs=1e-3)  # radius and height
    assert (x > 1, y) == (True, pytest.approx(0, abs=0.2))
    assert nose.axis == pytest.approx((-x / 4, -y / 4, -z / 4), abs=1e-3)
    assert len(session.state.undo_stack) == 1
    taller = played(*down, "drag 32,24 42,24", *up, "press V", "text 2", "press Return", text=text).state.element
    assert hypot(*taller.apex) == pytest.approx(5, abs=1e-3)  # it still stands there
    free = played(*down, "drag 32,24 62,2", *up, text=text).state.element
    assert free.axis == (0, 0, -1)
    assert free.apex[2] == 4


SKY = "sp 0,0,0 9000 9,9,9\n"  # around everything


@pytest.mark.parametrize(
    ("text", "lines"),
    [(TEXT, ()), (TEXT + SKY, ()), *((TEXT, (each,)) for each in ("click 33,23", "press Tab", "press Ctrl+D"))],
)
@pytest.mark.parametrize("start", [(40, 24), (10, 40), (10, 10)])
def test_the_camera_orbits_what_is_under_the_pointer_or_in_the_middle(start, text, lines):
    """On the cylinder; on the plane and on the sky it is the sphere in the middle, whatever is selected."""
    state = played(*lines, text=text).state
    _, pivot = pick(scene(), WIDTH, HEIGHT, *(start if start == (40, 24) else (WIDTH // 2, HEIGHT // 2)))
    x, y = start
    after = played(*lines, f"drag {x},{y} {x + 12},{y + 6} right", text=text).state
    old, new = state.scene.camera, after.scene.camera
    assert new != old
    assert dist(new.position, pivot) == pytest.approx(dist(old.position, pivot), rel=1e-5)
    pixels = [projection_of(camera, WIDTH, HEIGHT).pixel(pivot) for camera in (old, new)]
    assert pixels[0] == pytest.approx(pixels[1], abs=1e-3)
    assert after.element.title == state.element.title


def test_the_camera_orbits_the_centre_of_the_scene_where_nothing_is_seen():
    text = TEXT.replace("C 0,0,10 0,0,-1", "C 0,0,10 0,0.9,-1")
    before, after = (played(*lines, text=text).state.scene for lines in ((), ("drag 10,2 22,8 right",)))
    pivot = scene_centre(before)
    assert dist(after.camera.position, pivot) == pytest.approx(dist(before.camera.position, pivot), rel=1e-5)
    assert after.camera.position != before.camera.position


def test_orbiting_stops_straight_above():
    camera = played("drag 10,0 10,47 right").state.scene.camera
    assert camera.direction[1] == pytest.approx(-1)


def test_the_camera_pans():
    session = played("drag 33,23 45,15 middle")
    camera = session.state.scene.camera
    point = pick(scene(), WIDTH, HEIGHT, *FROM)[1]
    assert projection_of(camera, WIDTH, HEIGHT).pixel(point) == pytest.approx([each + HALF for each in TO], abs=1e-3)
    assert camera.direction == scene().camera.direction
    session = played("drag 5,3 9,3 middle")  # on nothing: what follows the pointer is as far away as the scene is large
    camera, size = session.state.scene.camera, session.state.size
    way = 4 * 2 * hypot(*PROJECTION.right) / WIDTH * size
    assert dist(camera.position, scene().camera.position) == pytest.approx(way, rel=1e-2)
    assert camera.position[0] < 0


@pytest.mark.parametrize("line", [DRAG, f"{DRAG} right", f"{DRAG} middle", "drag 5,3 20,12"])
def test_a_drag_is_one_undo_step(line):
    session = played(line)
    assert len(session.state.undo_stack) == 1
    assert played(line, "press Ctrl+Z").state.scene.items == scene().items
    assert played(line, "press Ctrl+Z", "press Ctrl+Y").state.scene.items == session.state.scene.items


def test_drags_are_steps_of_their_own_whatever_their_paths_and_pauses():
    assert len(played(DRAG, "drag 45,15 33,23").state.undo_stack) == 2
    assert len(played("press Tab", "press Tab", "press d", DRAG, "press d").state.undo_stack) == 3
    there_and_back = played("drag 33,23 60,40", "press Ctrl+Z", DRAG)
    assert there_and_back.state.scene.items == played(DRAG).state.scene.items
    harness = dragging()
    harness.memory.wait(3)
    harness.memory.motion(*TO)
    harness.memory.play()
    assert len(harness.session.state.undo_stack) == 1


def dragging() -> SessionHarness:
    """A session in the middle of a drag of the sphere."""
    harness = SessionHarness()
    harness.memory.button_press(1, *FROM)
    harness.play("move 40,20")
    assert len(harness.session.state.undo_stack) == 1
    return harness


@pytest.mark.parametrize(
    "end",
    [
        lambda memory: memory.button_release(1, 40, 20),
        lambda memory: memory.do(lambda: memory.window.on_focus(False)),
        lambda memory: memory.resize(80, 60),
        lambda memory: memory.tap(Key.CONTROL_L, Key.Z),
        lambda memory: memory.tap(Key.DELETE),
        lambda memory: memory.button_press(3, 1, 1),
    ],
)
def test_these_actions_end_a_drag(end):
    harness = dragging()
    end(harness.memory)
    harness.memory.play()
    after = harness.session.state.scene
    harness.memory.motion(*TO)
    harness.memory.play()
    assert harness.session.state.scene is after or harness.session.pressed


def test_a_click_with_a_small_movement_moves_nothing():
    harness = SessionHarness()
    harness.memory.button_press(1, *FROM)
    harness.memory.motion(FROM[0] + 3, FROM[1] - 3)
    harness.memory.button_release(1, FROM[0] + 3, FROM[1] - 3)
    harness.memory.play()
    assert harness.session.state.element.title == "sphere"
    assert harness.session.state.undo_stack == ()


def test_a_right_click_on_nothing_selects_the_camera_and_a_right_drag_does_not():
    assert played("click 33,23", "click 5,5 right").state.element.title == "camera"
    assert played("click 33,23", "drag 5,5 30,5 right").state.element.title == "sphere"

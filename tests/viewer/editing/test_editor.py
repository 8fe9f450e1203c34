"""Effects of editing actions on a scene, with results computed by hand."""

from __future__ import annotations

from math import cos, hypot, radians, sin

import pytest

from minirt.fields import FARTHEST, unit
from minirt.fields.scalars import LEAST_LENGTH
from minirt.scene import Camera, FurtherCamera, FurtherLight, Light, dump
from minirt.shapes import Cylinder, Plane, Sphere
from minirt.viewer.editing.editor import TURN_STEP, apply
from minirt.viewer.editing.motion import turn_camera
from minirt.viewer.editing.rigid import rodrigues
from minirt.viewer.editing.state import STEP_SHARE, State, initial_state
from tests.viewer.fake import scene

U = 2.0**-53  # unit roundoff of float64
MANY = 100_000  # turns


def selecting(kind: type, text: str | None = None) -> State:
    """The state with the first element of a kind selected, in which a step of a movement has length 1."""
    state = initial_state(scene(text) if text else scene())
    index = next(index for index, each in enumerate(state.scene.elements) if type(each) is kind)
    return State(state.scene, index, state.file_cameras, 1 / STEP_SHARE)


def after(state: State, *actions: str, amount: float = 1.0) -> State:
    """The state after some actions."""
    for action in actions:
        state = apply(state, action, amount)
    return state


def with_frame(state: State, frame: str) -> State:
    """The state with another frame of movement."""
    while state.frame.name != frame:
        state = apply(state, "next frame")
    return state


@pytest.mark.parametrize(("kind", "name"), [(Light, "position"), (Sphere, "centre"), (Plane, "point")])
def test_every_element_with_a_position_moves_along_the_axes(kind, name):
    state = selecting(kind)
    x, y, z = getattr(state.element, name)
    for frame, expected in (("X", (x + 1, y, z)), ("Y", (x, y + 1, z)), ("Z", (x, y, z + 1))):
        for plus, minus in (("right", "left"), ("forward", "back"), ("up", "down")):
            moved = after(with_frame(state, frame), plus)
            assert getattr(moved.element, name) == expected
            assert getattr(after(moved, minus).element, name) == (x, y, z)
    assert after(with_frame(selecting(Camera), "X"), "up").element.position == (0, 1, 10)  # whatever the frame


@pytest.mark.parametrize(
    ("action", "axis"),
    [
        ("turn right", (0, 1, 0)),  # about itself
        ("roll right", (1, 0, 0)),
        ("roll left", (-1, 0, 0)),
        ("turn up", (0, 0, -1)),  # the front goes up, so the top goes away from the camera
        ("turn down", (0, 0, 1)),
    ],
)
def test_a_cylinder_turns_in_the_view(action, axis):
    turned = after(selecting(Cylinder), action, amount=90 / TURN_STEP)
    assert turned.element.axis == pytest.approx(axis, abs=1e-15)


@pytest.mark.parametrize(("frame", "axis"), [("X", (0, 0, 1)), ("Y", (0, 1, 0)), ("Z", (-1, 0, 0))])
def test_a_cylinder_turns_right_handed_about_an_axis(frame, axis):
    for action in ("turn right", "turn up", "roll right"):
        turned = after(with_frame(selecting(Cylinder), frame), action, amount=90 / TURN_STEP)
        assert turned.element.axis == pytest.approx(axis, abs=1e-15)


def test_next_value_cycles_through_the_values_and_previous_value_goes_back():
    state = selecting(Cylinder)
    there, back = [], []
    for _ in range(15):
        there.append(state.active.name)
        state = after(state, "next value")
    for _ in range(15):
        state = after(state, "previous value")
        back.append(state.active.name)
    colours = ["colour", "colour: red", "colour: green", "colour: blue"]
    places = [f"centre: {part}" for part in "xyz"]
    turns = [f"axis: {part}" for part in ("x", "y", "z", "heading", "elevation")]
    assert there == ["diameter", "height", *colours, *places, *turns, "diameter"]
    assert back == there[::-1]
    plane = selecting(Plane)
    assert plane.active.name == "colour"
    assert after(plane, "shrink").element.colour == (0, 247, 0)
    assert after(selecting(Cylinder), "next value", "grow").element.height == pytest.approx(4 * 1.05)
    assert after(selecting(Camera), "grow").element.fov == 92
    assert after(selecting(Light), "grow").element.brightness == pytest.approx(0.55)


def test_scaling_down_stops_at_the_least_size():
    state = selecting(Sphere)
    for _ in range(2000):
        state = apply(state, "shrink")
    assert state.element.diameter == LEAST_LENGTH
    assert "no further" in state.message or "cannot go further" in state.message


def test_moving_stops_at_the_end_of_the_range():
    state = after(selecting(Sphere), "right", amount=1e300)
    assert state.element.centre == (FARTHEST, 0, 0)
    assert "no further" in state.message
    again = after(state, "right")
    assert again.scene is state.scene
    assert after(again, "left", amount=FARTHEST).element.centre == (0, 0, 0)


def test_many_turns_keep_unit_length():
    start, about, camera = selecting(Cylinder).element.axis, (0.6, 0.0, 0.8), scene().camera
    axis = start
    for _ in range(MANY):
        axis, camera = unit(rodrigues(axis, about, 0.1)), turn_camera(camera, 0.1, 0.0)
        assert max(abs(hypot(*each) - 1) for each in (axis, camera.direction)) <= 4 * U
    # 10,000 degrees are 27 whole turns and 280 degrees.
    assert axis == pytest.approx(rodrigues(start, about, 280), abs=1e-9)
    assert camera.direction == pytest.approx((sin(radians(280)), 0, -cos(radians(280))), abs=1e-9)


class TestStraightUp:
    def test_it_is_reached_and_left_again(self):
        for action, back, y in (("turn up", "turn down", 1.0), ("turn down", "turn up", -1.0)):
            start = after(selecting(Camera), "turn right", amount=7)
            end = after(start, action, amount=100)
            assert end.element.direction[1] == y
            assert hypot(*end.element.direction) == 1
            assert after(end, action).scene is end.scene
            returned = after(end, back, amount=90 / TURN_STEP)
            assert returned.element.direction == pytest.approx(start.element.direction, abs=1e-15)

    def test_the_heading_turns_there(self):
        up = after(selecting(Camera), "turn up", "turn right", amount=90 / TURN_STEP)
        assert up.element.direction[1] == 1
        assert after(up, "turn down", amount=90 / TURN_STEP).element.direction == pytest.approx((1, 0, 0), abs=1e-15)

    @pytest.mark.parametrize("y", [1, -1])
    def test_a_camera_of_a_file_leaves_it_without_a_jump(self, y):
        state = selecting(Camera, f"A 0 0,0,0\nC 0,0,0 0,{y},0 60\n")
        left = after(state, "turn down" if y > 0 else "turn up", amount=90 / TURN_STEP)
        # The top of the picture is +z looking up and -z looking down; the way out leads down or up in the picture.
        assert left.element.direction == pytest.approx((0, 0, -1), abs=1e-15)


def test_roll_turns_the_camera_about_its_direction():
    state = after(selecting(Camera), "roll right")
    assert (state.element.roll, state.element.direction) == (TURN_STEP, (0, 0, -1))
    assert after(state, "roll left").element.roll == 0
    assert after(selecting(Camera), "roll right", amount=359 / TURN_STEP).element.roll == 359
    assert abs(after(selecting(Camera), "roll right", amount=1e6).element.roll) <= 360


class TestSelection:
    def test_it_is_cyclic(self):
        state = selecting(Camera)
        titles = []
        for _ in range(6):
            state = apply(state, "select next")
            titles.append(state.element.title)
        assert titles == ["light", "sphere", "plane", "cylinder", "ambient light", "camera"]
        assert after(state, "select previous").element.title == "ambient light"

    def test_it_cycles_through_the_lights(self):
        text = "A 0 0,0,0\nC 0,0,0 0,0,1 60\nL 1,1,1 1\nl 2,2,2 1\n"
        state = selecting(Camera, text)
        places = []
        for _ in range(3):
            state = apply(state, "select light")
            places.append(state.element.position[0])
        assert places == [1, 2, 1]
        assert after(state, "select camera").element is state.scene.camera
        assert "no light" in after(selecting(Camera, "A 0 0,0,0\nC 0,0,0 0,0,1 60\n"), "select light").message


CAMERAS = """\
A 0 0,0,0
C 0,0,10 0,0,-1 60
c 10,0,0 -1,0,0 50
c 0,10,0 0,-1,0 40  # from above
sp 0,0,0 2 255,0,0
"""


class TestCameras:
    def test_a_key_goes_through_them_without_an_edit_of_the_file(self):
        state, seen = initial_state(scene(CAMERAS)), []
        for _ in range(4):
            state = apply(state, "select camera")
            seen.append((state.scene.camera.fov, state.message))
            assert state.element is state.scene.camera
            assert dump(state.scene) == CAMERAS
        assert [fov for fov, _ in seen] == [50, 40, 60, 50]
        assert seen[0][1] == "camera 2 of 3"
        assert after(state, "undo").scene.camera.fov == 60
        assert after(state, "select next", "select camera").scene.shown == state.scene.shown

    def test_the_one_in_view_is_moved_and_reset(self):
        state = after(initial_state(scene(CAMERAS)), "select camera", "select camera")
        moved = after(state, "forward")
        assert dump(moved.scene).splitlines()[3].split()[1] == "0,10,-0.2"  # to the top of the picture
        assert moved.scene.cameras[:2] == state.scene.cameras[:2]
        assert dump(after(moved, "reset camera").scene) == CAMERAS

    def test_another_one_moves_as_a_light_does(self):
        state = initial_state(scene(CAMERAS)).select(2)
        assert after(with_frame(state, "X"), "right").scene.cameras[1].position == (10.2, 0, 0)
        assert after(state, "right").scene.camera is state.scene.camera
        assert after(state, "grow").scene.cameras[1].fov > 50

    @pytest.mark.parametrize(("deleted", "fov"), [(2, 40), (3, 60)])
    def test_the_one_in_view_stays_when_another_is_deleted(self, deleted, fov):
        state = after(initial_state(scene(CAMERAS)), "select camera", "select camera")
        state = after(state.select(deleted), "delete")
        assert (len(state.scene.cameras), state.scene.camera.fov) == (2, fov)
        assert state.element is state.scene.camera


class TestStructure:
    def test_a_copy_follows_its_original_and_is_selected(self):
        state = after(selecting(Sphere), "duplicate")
        assert [each.title for each in state.scene.elements[3:6]] == ["sphere", "sphere", "plane"]
        assert state.selected == 4
        assert state.element.centre == (2.4, 0, 0)  # beside it, a fifth of its diameter apart
        moved = after(state, "right")
        assert [each.centre for each in moved.scene.spheres] == [(0, 0, 0), (3.4, 0, 0)]
        assert after(selecting(Plane), "duplicate").element.point == selecting(Plane).element.point

    @pytest.mark.parametrize(("kind", "further"), [(Light, FurtherLight), (Camera, FurtherCamera)])
    def test_the_copy_of_a_light_or_camera_is_a_further_one(self, kind, further):
        state = selecting(kind)
        copy = after(state, "duplicate").element
        assert type(copy) is further
        assert copy.position == state.element.position

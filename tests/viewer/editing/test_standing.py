"""A shape that stands on something stays on it while its size changes or it turns, wherever its position is."""

from __future__ import annotations

from math import sqrt

import pytest

from minirt.fields import Triple
from minirt.shapes import Cylinder
from minirt.viewer.editing.handles import SIZE, handles_of
from minirt.viewer.editing.projection import position_of, projection_of
from minirt.viewer.editing.state import State
from minirt.viewer.editing.typed import set_typed
from minirt.viewer.editing.values import values
from tests.viewer.fake import played, scene

HEAD = "A 0.2 255,255,255\nC 0,2,-9 0,-0.1,1 60\n"
CONE = "co 0,3,0 0,-1,0 2 3 9,9,9"  # on its base, on the ground y = 0
HEIGHT = ("press Tab", "press V")  # select the shape, and its height
LINES = {
    CONE: (0, 4, 0),
    "co 0,0,0 0,1,0 2 3 9,9,9": (0, 0, 0),  # on its apex
    "pa 0,3,0 0,-1,0 2 3 9,9,9": (0, 4, 0),
    "pa 0,0,0 0,1,0 2 3 9,9,9": (0, 0, 0),
    "co 0,2,0 0,-1,0 2 3 9,9,9\npl 0,-1,0 0,1,0 9,9,9": (0, 3, 0),
    "co 0,5,0 0,-1,0 2 3 9,9,9\nsp 0,1,0 2 9,9,9": (0, 6, 0),
    "co 0,5,0 0,-1,0 2 3 9,9,9\npl 0,0,0 0,1,0 9,9,9": (0, 5, 0),  # on nothing
    "co 0,3,0 1,0,0 2 3 9,9,9": (0, 3, 0),  # on its side
    "cy 0,1.5,0 0,1,0 2 3 9,9,9": (0, 2, 0),  # its position is its middle
    "cy 0,1.6,0 0,1,0 2 3 9,9,9": (0, 1.6, 0),  # on nothing
}


def edited(line: str, *keys: str) -> State:
    """The state after keys, with the height of the shape in a line as the active value."""
    return played(*HEIGHT, *keys, text=f"{HEAD}{line}\n").state


@pytest.mark.parametrize(("line", "there"), LINES.items())
def test_it_grows_away_from_what_it_stands_on(line: str, there: Triple) -> None:
    typed = "4" if line == CONE else "=+=1"
    state = edited(line, f"text {typed}", "press Return")
    assert state.element.height == 4
    assert position_of(state.element) == there
    assert len(state.undo_stack) == 1
    assert edited(line, f"text {typed}", "press Return", "press Ctrl+Z").scene.items == scene(f"{HEAD}{line}\n").items
    assert edited(line, "press Shift+V", "text 5", "press Return").element.diameter == 5


@pytest.mark.parametrize("lines", [("press +",) * 3, ("down F3", "text +", "wait 0.4", "up F3"), ("press -",) * 5])
def test_steps_leave_the_base_where_it_is(lines: tuple[str, ...]) -> None:
    cone = edited(CONE, *lines).element
    assert cone.height != 3
    assert cone.apex == pytest.approx((0, cone.height, 0), abs=1e-5)


def test_a_wider_one_stays_where_it_is() -> None:
    assert edited(CONE, "press Shift+V", "press +").element.apex == (0, 3, 0)


@pytest.mark.parametrize(("height", "rest"), [(1, 1.5), (2, 2), (1.01, 1.01)])
def test_a_ball_that_stands_grows_upwards(height: float, rest: float) -> None:
    text = f"{HEAD}sp 0,{height},0 2 9,9,9\n"
    ball = played("press Tab", "text 3", "press Return", text=text).state.element
    assert (ball.diameter, ball.centre) == (3, (0, rest, 0))


@pytest.mark.parametrize("added", [False, True])
def test_a_handle_leaves_the_base_where_it_is_all_along_the_drag(added: bool) -> None:
    """A new cone stands where the pointer was; one of a file on its base."""
    start = ["press N", "press c", "press o", "press n", "press e", "press Return"] if added else list(HEIGHT)
    text = HEAD if added else f"{HEAD}{CONE}\n"
    opened = ["resize 640x480", "move 320,280", *start]
    state = played(*opened, text=text).state
    before = state.element
    (handle,) = [
        each
        for each in handles_of(before, projection_of(state.scene.camera, 640, 480), 1.0)
        if (each.kind, each.axis) == (SIZE, 1)
    ]
    x, y = map(int, handle.points[0])
    after = played(*opened, f"drag {x},{y} {x},{y - 60}", text=text).state.element
    assert after.height > 1.2 * before.height
    assert before.apex[1] - before.height == pytest.approx(0, abs=1e-3)
    assert after.apex[1] - after.height == pytest.approx(0, abs=1e-3)


TURNS = (
    ("press .",),
    ("press .",) * 7,
    ("down Up", "wait 1.3", "up Up"),
    ("press Up",) * 3,
    ("down Shift", "drag 320,240 400,330", "up Shift"),
)


def lower_end(cylinder: Cylinder) -> float:
    """The least y of a capped cylinder: of its lower rim."""
    slope = min(1.0, abs(cylinder.axis[1]))
    return cylinder.centre[1] - cylinder.height / 2 * slope - cylinder.diameter / 2 * sqrt(1 - slope * slope)


@pytest.mark.parametrize("turns", TURNS, ids="|".join)
def test_it_neither_sinks_nor_floats_when_it_turns(turns: tuple[str, ...]) -> None:
    text = f"{HEAD}cy 0,1.5,0 0,1,0 2 3 9,9,9\n"
    opened = played("resize 640x480", "press Tab", text=text).state
    after = played("resize 640x480", "press Tab", *turns, text=text).state
    cylinder = after.element
    assert isinstance(cylinder, Cylinder)
    assert abs(cylinder.axis[1]) < 0.999
    assert lower_end(cylinder) == pytest.approx(0, abs=0.01 * opened.stride)
    back = played("resize 640x480", "press Tab", *turns, "press Ctrl+Z", text=text).state
    assert back.scene.items == opened.scene.items


def test_a_typed_axis_leaves_it_on_the_ground() -> None:
    state = edited("cy 0,1.5,0 0,1,0 2 3 9,9,9")
    (axis,) = {each._replace(channel=None) for each in values(state.element) if each.field.name == "axis"}
    turned = set_typed(state, axis, "1,0,0", 0.0).element
    assert (turned.axis, turned.centre) == ((1, 0, 0), (0, 1, 0))


def test_what_stands_on_nothing_turns_where_it_is() -> None:
    turned = edited("cy 0,1.6,0 0,1,0 2 3 9,9,9", *["press ."] * 7).element
    assert turned.centre == (0, 1.6, 0)
    assert turned.axis != (0, 1, 0)

"""Handles on the selected element: what a drag of each does, and when they are there."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import degrees, dist, hypot

import numpy as np
import pytest

from minirt.scene import Camera
from minirt.viewer.app.session import Session
from minirt.viewer.display.marks import AXIS_COLOURS, arrow_tip, arrows, bgra
from minirt.viewer.editing.dragging import DragStart, pull
from minirt.viewer.editing.handles import MOVE, SIZE, SLIDE, TURN, Handle, handles_of
from minirt.viewer.editing.projection import Projection, projection_of, subtract
from minirt.viewer.editing.state import State
from tests.viewer.fake import played
from tests.viewer.session_harness import SessionHarness

WIDTH, HEIGHT = 640, 480
TEXT = """A 0.2 255,255,255
C 4,3,9 -0.37,-0.28,-0.885 60
bo 0.3,0.2,0.1 0,1,0 2,1,1.5 9,9,9
cy 30,0,0 0,1,0 1 4 0,0,255
L 5,5,-40 0.5 255,255,255
"""
OPEN = (f"resize {WIDTH}x{HEIGHT}", "press Tab")
CENTRE = (0.3, 0.2, 0.1)


@cache
def opened() -> State:
    """Return the state of a window in which the box is selected."""
    return played(*OPEN, text=TEXT).state


@cache
def view() -> Projection:
    """Return the view of that window."""
    return projection_of(opened().scene.camera, WIDTH, HEIGHT)


def handle(kind: str, axis: int) -> Handle:
    """Return a handle of the box."""
    (found,) = [each for each in handles_of(opened().element, view(), 1.0) if (each.kind, each.axis) == (kind, axis)]
    return found


def spelled(pixel: tuple[float, float]) -> str:
    """Return the pixel of a place in the picture, as recordings spell it."""
    return f"{int(pixel[0])},{int(pixel[1])}"


def pulled(kind: str, axis: int, to: tuple[float, float], *, snap: bool = False, corner: int = 0) -> Session:
    """Return the session after a drag of a handle of the box by an offset in pixels."""
    x, y = handle(kind, axis).points[corner]
    held = ("down Ctrl", "up Ctrl") if snap else ("wait 0.1", "wait 0.1")
    drag = f"drag {spelled((x, y))} {spelled((x + to[0], y + to[1]))}"
    session = played(*OPEN, held[0], drag, held[1], text=TEXT)
    assert len(session.state.undo_stack) == 1
    assert session.state.element.title == "box"
    return session


@pytest.mark.parametrize("axis", range(3))
def test_an_arrow_moves_along_its_axis_and_follows_the_pointer(axis: int) -> None:
    tip = handle(MOVE, axis).points[0]
    middle = view().pixel(CENTRE)
    assert middle
    way = [0.6 * (a - b) for a, b in zip(tip, middle, strict=True)]
    centre = pulled(MOVE, axis, (way[0], way[1])).state.element.centre
    assert [i for i in range(3) if centre[i] != CENTRE[i]] == [axis]
    assert centre[axis] > CENTRE[axis]
    there, wanted = view().pixel(centre), (middle[0] + way[0], middle[1] + way[1])
    assert there
    assert dist(there, wanted) < 5  # pixels of 40: the middle moved as the tip did, but for perspective
    snapped = pulled(MOVE, axis, (way[0], way[1]), snap=True).state
    steps = snapped.element.centre[axis] / snapped.stride
    assert steps == pytest.approx(round(steps), abs=1e-6)
    assert [i for i in range(3) if snapped.element.centre[i] != CENTRE[i]] == [axis]


def test_the_square_moves_in_the_level_plane_under_the_pointer() -> None:
    centre = pulled(SLIDE, 1, (60, -25)).state.element.centre
    start = handle(SLIDE, 1).points[0]
    assert centre[1] == CENTRE[1]
    offset = subtract(centre, CENTRE)
    ray, eye = view().ray(int(start[0]) + 0.5, int(start[1]) + 0.5), view().eye
    depth = (CENTRE[1] - eye[1]) / ray[1]
    moved = [a + depth * part + way for a, part, way in zip(eye, ray, offset, strict=True)]
    pixel = view().pixel((moved[0], moved[1], moved[2]))
    assert pixel
    assert dist(pixel, (int(start[0] + 60) + 0.5, int(start[1] - 25) + 0.5)) < 0.5


@pytest.mark.parametrize("axis", range(3))
def test_a_ring_turns_about_its_axis_as_the_pointer_goes_around(axis: int) -> None:
    """By as much as the corner of the ring that the pointer goes to is from the one where it began."""
    ring = handle(TURN, axis).points
    corners = 3, 6  # of 48
    offset = ring[corners[1]][0] - ring[corners[0]][0], ring[corners[1]][1] - ring[corners[0]][1]
    state = pulled(TURN, axis, offset, corner=corners[0], snap=True).state
    before = opened().element.frame()
    after = state.element.frame()
    trace = sum(a.x * b.x + a.y * b.y + a.z * b.z for a, b in zip(before, after, strict=True))
    angle = degrees(np.arccos((trace - 1) / 2))
    assert angle / 15 == pytest.approx(round(angle / 15), abs=1e-3)
    assert 0 < angle <= 75
    turned = pulled(TURN, axis, offset, corner=corners[0]).state.element
    vectors = [np.array([(v.x, v.y, v.z) for v in frame]).T for frame in (before, turned.frame())]
    rotation = vectors[1] @ vectors[0].T
    skew = (rotation - rotation.T)[(axis + 2) % 3, (axis + 1) % 3]  # positive: counter-clockwise, as the corners go
    assert skew > 0


@pytest.mark.parametrize("is_mirrored", [False, True])
@pytest.mark.parametrize("axis", range(3))
def test_a_ring_follows_the_pointer_all_around_in_mirrored_pictures_too(axis: int, is_mirrored: bool) -> None:
    scene = opened().scene.mirrored() if is_mirrored else opened().scene
    state, box = replace(opened(), scene=scene), opened().element
    projection = projection_of(scene.camera, WIDTH, HEIGHT)
    (ring,) = [each for each in handles_of(box, projection, 1.0) if (each.kind, each.axis) == (TURN, axis)]
    before = np.array([(v.x, v.y, v.z) for v in box.frame()]).T
    for begin, end in zip(ring.points, [*ring.points[3:], *ring.points[:3]], strict=True):
        x, y = round(begin[0]), round(begin[1])
        reach = end[0] - x, end[1] - y
        turned = pull(state, DragStart(projection, x, y, box, scene.camera, None, handle=ring, reach=reach), x, y)
        rotation = np.array([(v.x, v.y, v.z) for v in turned.element.frame()]).T @ before.T
        sine = (rotation - rotation.T)[(axis + 2) % 3, (axis + 1) % 3] / 2
        angle = degrees(np.arctan2(sine, (np.trace(rotation) - 1) / 2))
        assert 5 <= angle <= 75, f"22.5 degrees counter-clockwise, seen at an angle: {angle}"
        assert turned.message.startswith(f"turned by {angle:.3g} degrees")


def test_over_the_centre_a_box_handle_does_nothing_and_an_arrow_moves() -> None:
    """The ray there meets the axis at the centre: how many times as far away the pointer went has no answer."""
    text = "A 1 9,9,9\nC 0,0,9 0,0,-1 60\nbo 0,0,0 0,1,0 2,1,1 9,9,9"
    state = played(*OPEN, text=text).state
    box, camera = state.element, state.scene.camera
    view = projection_of(camera, 641, 481)
    by_kind = {each.kind: each for each in handles_of(box, view, 1.0) if each.axis == 0}
    start = DragStart(view, 320, 240, box, camera, None, reach=(90.0, 0.0))
    resized, moved = (pull(state, start._replace(handle=by_kind[kind]), 0, 0) for kind in (SIZE, MOVE))
    assert (resized.element, resized.message) == (box, "the view is along the axis: nothing moves")
    assert moved.element.centre[0] > 1


@pytest.mark.parametrize(("axis", "old"), [(0, 2.0), (1, 1.0), (2, 1.5)])
def test_a_box_handle_changes_one_size_in_proportion(axis: int, old: float) -> None:
    start = handle(SIZE, axis).points[0]
    middle = view().pixel(CENTRE)
    assert middle
    way = start[0] - middle[0], start[1] - middle[1]
    element = pulled(SIZE, axis, (0.5 * way[0], 0.5 * way[1])).state.element
    ratios = [new / before for new, before in zip(element.sizes, (2.0, 1.0, 1.5), strict=True)]
    assert ratios.pop(axis) == pytest.approx(1.5, rel=0.1)  # perspective
    assert ratios == [1.0, 1.0]
    snapped = pulled(SIZE, axis, (0.5 * way[0], 0.5 * way[1]), snap=True).state
    strides = snapped.element.sizes[axis] / snapped.stride
    assert strides == pytest.approx(round(strides), abs=1e-6)
    through = pulled(SIZE, axis, (-way[0], -way[1])).state.element.sizes[axis]
    assert through > 0


@pytest.mark.parametrize(("kind", "axis"), [(MOVE, 0), (MOVE, 1), (SLIDE, 1), (SIZE, 1), (TURN, 1)])
def test_shift_makes_a_tenth_of_what_a_handle_does_from_then_on(kind: str, axis: int) -> None:
    """As far as perspective and the curve of a ring are straight; where Shift goes down nothing jumps."""
    start = handle(kind, axis).points[0]
    corners = [spelled((start[0] + 12 * step, start[1] - 6 * step)) for step in range(3)]
    press, *moves = (f"move {corner}" for corner in corners)

    def change(*lines: str) -> float:
        harness = SessionHarness(text=TEXT)
        harness.session.screen.handles = True
        harness.play(*OPEN, press)
        x, y = map(int, corners[0].split(","))
        harness.memory.button_press(1, x, y)
        harness.play(*lines)
        element = harness.session.state.element
        assert harness.session.state.selected == 2
        return dist(element.centre, CENTRE) + abs(element.sizes[1] - 1.0) + abs(element.roll)

    whole, tenth = change(moves[0]), change("down Shift", moves[0])
    assert tenth == pytest.approx(whole / 10, rel=0.15)
    assert change(moves[0], "down Shift") == whole
    assert change(moves[0], "down Shift", moves[1]) == pytest.approx(whole * 1.1, abs=0.01)  # a pixel
    assert change("down Shift", moves[0], "up Shift", moves[1]) == pytest.approx(whole * 1.1, rel=0.15)


def test_a_drag_that_slides_along_surfaces_leaves_handles_alone() -> None:
    x, y = handle(MOVE, 0).points[0]
    for chord in ("Alt", "Ctrl+Shift"):
        keys = chord.split("+")
        drag = f"drag {spelled((x, y))} {spelled((x + 30, y))}"
        session = played(*OPEN, *(f"down {key}" for key in keys), drag, *(f"up {key}" for key in keys), text=TEXT)
        assert session.state.scene.boxes[0].centre[1] == 0.5  # on the ground


def coloured(session: Session) -> bool:
    """Whether the window shows something in the colours of all axes."""
    frame = session.screen.frame
    return all((frame == np.array(bgra(colour), np.uint8)).all(axis=2).any() for colour in AXIS_COLOURS.values())


def test_handles_are_shown_while_no_key_is_held_and_go_with_a_key() -> None:
    seen: list[bool] = []
    assert coloured(played(*OPEN, text=TEXT))
    played(
        *OPEN, "hold d 0.3", text=TEXT, watch=lambda session: seen.append(bool(session.held_keys) and coloured(session))
    )
    assert not any(seen)
    assert not coloured(played(*OPEN, "press K", text=TEXT))
    assert not coloured(played(*OPEN, "press C", text=TEXT))
    assert not coloured(played(*OPEN, "press I", "press I", text=TEXT))
    assert handles_of(opened().element, projection_of(Camera((0, 0, 9), (0, 0, -1), 60), 64, 48), 1) == []
    off = played(*OPEN, "press K", f"drag {spelled(handle(MOVE, 0).points[0])} 500,100", text=TEXT).state
    assert off.scene.boxes[0].sizes == (2, 1, 1.5)


def test_a_click_on_an_arrow_at_the_edge_selects_and_frames_the_light() -> None:
    aside = TEXT.replace("-0.37,-0.28,-0.885", "-0.9,-0.28,0.3")  # the light is behind the camera
    state = played(*OPEN, "press C", "press L", text=aside).state
    seen = projection_of(state.scene.camera, WIDTH, HEIGHT)
    ((owner, way),) = arrows(state.scene, state.chosen, seen, every=False).items()
    tip = arrow_tip(way, WIDTH, HEIGHT, 1.0)
    assert owner == state.selected
    framed = played(*OPEN, "press C", "press L", f"click {spelled(tip)}", text=aside).state
    pixel = projection_of(framed.scene.camera, WIDTH, HEIGHT).pixel(framed.element.position)
    assert pixel
    assert hypot(pixel[0] - WIDTH / 2, pixel[1] - HEIGHT / 2) < 2
    ways = arrows(state.scene, [1], seen, every=True)  # with the icons of lights, another element is selected
    tip = arrow_tip(ways[owner], WIDTH, HEIGHT, 1.0)
    every = played(*OPEN, "press C", "press G", f"click {spelled(tip)}", text=aside).state
    assert every.element.title == "light"

"""New elements: under the pointer, standing on what is there, of the next kind; and shapes that are dropped."""

from __future__ import annotations

from contextlib import suppress
from math import dist, hypot, sqrt
from pathlib import Path

import numpy as np
import pytest

from minirt.fields import Triple
from minirt.lanes import Vec
from minirt.rendering.packing.ray_casting import distances_of
from minirt.rendering.queries.pick import clearance, pick
from minirt.scene import Scene, load
from minirt.scene.registry import ELEMENTS
from minirt.shapes import KINDS, Box, Cylinder, Shape, Sphere, Triangle
from minirt.shapes.frames import basis
from minirt.viewer.editing.defaults import default_element
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.placing import SHARE, aim, dropped, middle_of, stand
from minirt.viewer.editing.projection import looked_at_distance, projection_of
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.editing.structure import ELEMENT, addable_kinds, choices
from tests.viewer.fake import scene

HEAD = "A 0.2 255,255,255\nC 0,3,10 0,-0.2,-1 60\nL 5,9,5 0.6\n"
GROUND = "pl 0,0,0 0,1,0 99,99,99\n"
RED = (255, 0, 0)
SIZE = 640, 360
BARE = "A 0.2 255,255,255\nC 3,1,4 0.6,-0.2,0.7 50 roll:30\n"


def aiming(state: State, x: int, y: int) -> State:
    """The state that aims through the centre of a pixel of a window of SIZE."""
    camera = state.scene.camera
    found = aim(projection_of(camera, *SIZE), state.size, x + 0.5, y + 0.5, *pick(state.scene, *SIZE, x, y))
    return State(state.scene, state.selected, state.file_cameras, state.size, aim=found)


def added(text: str, x: int, y: int, kind: str = "sp") -> tuple[State, Shape]:
    """The state that aims through a pixel, and a new element there."""
    state = aiming(initial_state(scene(text)), x, y)
    (found,) = [each for each in addable_kinds(state.scene) if each.code == kind]
    made = default_element(found, state)
    assert isinstance(made, Shape)
    return state, made


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e5])
def test_a_new_element_fills_a_sensible_part_of_the_picture_at_any_scale(scale: float) -> None:
    """The ground is empty: nothing but the eye's height says how large the scene is."""
    state, ball = added(f"A 0.2 255,255,255\nC 0,{3 * scale},{10 * scale} 0,-0.3,-1 60\n", 320, 200)
    assert isinstance(ball, Sphere)
    view = projection_of(state.scene.camera, *SIZE)
    share = ball.diameter / view.depth(ball.centre) / (2 * hypot(*view.up))
    assert SHARE * 0.6 < share < SHARE * 1.6
    assert ball.centre[1] == pytest.approx(ball.diameter / 2, rel=1e-3)
    x, y = view.pixel((ball.centre[0], 0.0, ball.centre[2]))
    assert hypot(x - 320.5, y - 200.5) < 5


@pytest.mark.parametrize("ground", ["", GROUND])
@pytest.mark.parametrize("kind", ["sp", "cy", "co", "bo", "to", "el", "hy", "pa"])
def test_every_solid_stands_on_the_ground(kind: str, ground: str) -> None:
    state, made = added(HEAD + ground, 250, 240, kind)
    low, _ = made.bounds() or ((), ())
    assert low[1] == pytest.approx(0, abs=1e-3 * state.size)


@pytest.mark.parametrize(("x", "y"), [(320, 60), (350, 70), (250, 110), (390, 180), (320, 215)])
def test_a_ball_touches_the_ball_that_is_aimed_at(x: int, y: int) -> None:
    state, new = added(HEAD + "sp 0,2,0 4 9,9,9\n", x, y)
    assert state.aim is not None
    assert state.aim.normal is not None
    assert dist(state.aim.point, (0, 2, 0)) == pytest.approx(2)
    x_at, y_at, z_at = state.aim.point
    assert state.aim.normal == pytest.approx((x_at / 2, (y_at - 2) / 2, z_at / 2))
    assert isinstance(new, Sphere)
    assert dist(new.centre, (0, 2, 0)) == pytest.approx(2 + new.diameter / 2, rel=2e-3)


FRONT = "A 0.2 255,255,255\nC 0,2,6 0,0,-1 60\n"  # level with the middle of a head


@pytest.mark.parametrize("head", ["sp 0,2,0 1 9,9,9", "el 0,2,0 0,1,0 1,1.2,1 9,9,9", "bo 0,2,0 0,1,0 1,1,1 9,9,9"])
@pytest.mark.parametrize("kind", ["co", "cy", "bo", "hy", "pa", "to", "di", "sq", "el"])
def test_what_sticks_to_a_side_points_outwards_and_is_smaller(head: str, kind: str) -> None:
    state, made = added(f"{FRONT}{head}\n", 322, 179, kind)
    aimed = state.aim
    assert aimed is not None
    assert aimed.point == pytest.approx((0, 2, 0.5), abs=1e-9)  # 0.01 is 0 on the grid
    assert aimed.normal == pytest.approx((0, 0, 1), abs=1e-9)
    low, high = made.bounds() or ((), ())
    assert low[2] == pytest.approx(0.5, abs=0.01)
    assert max(b - a for a, b in zip(low, high, strict=True)) <= 0.4
    assert [(a + b) / 2 for a, b in zip(low, high, strict=True)][:2] == pytest.approx([0, 2], abs=1e-3)
    if kind == "co":
        assert made.axis == (0, 0, -1)  # type: ignore[attr-defined] - from the apex to the base


def test_a_hat_stands_upright_in_the_middle_of_a_head() -> None:
    view = "A 0.2 255,255,255\nC 0,4,6 0,-0.3,-1 60\n"
    state, hat = added(f"{view}sp 0.1,2,0 1 9,9,9\n", 333, 162, "cy")
    assert state.aim is not None
    assert 0.7 < state.aim.normal[1] < 1  # type: ignore[index]
    assert isinstance(hat, Cylinder)
    assert hat.axis == (0, 1, 0)
    assert hat.centre == pytest.approx((0.1, 2.5 + hat.height / 2, 0), abs=1e-3)
    assert hat.diameter <= 0.6


@pytest.mark.parametrize("normal", [(0.6, 0.0, 0.8), (0.48, -0.6, 0.64), (0.0, -1.0, 0.0), (0.36, 0.48, 0.8)])
@pytest.mark.parametrize(
    "kind", [each for each in ELEMENTS.values() if issubclass(each, Shape)], ids=lambda kind: kind.code
)
def test_every_kind_stands_on_a_slope_as_it_stands_on_the_ground(kind: type[Shape], normal: Triple) -> None:
    """Rays towards the slope find the lowest point of the shape at a distance of 0 from it, or where it is lifted."""
    state = initial_state(scene(FRONT))
    with suppress(LookupError):
        shape = default_element(kind, state)
        if shape.bounds() is None or isinstance(shape, Triangle):  # a triangle is not turned, and may be edge-on
            return
        standing = stand(shape, (1.0, 2.0, 3.0), normal)
        u, v, w = basis(normal)
        radius = middle_of(standing)[1]
        across = np.linspace(-1.3, 1.3, 201) * radius
        a, b = (each.ravel() for each in np.meshgrid(across, across))
        start = Vec(1.0 + 0 * a, 2.0, 3.0) - 9.0 * w + a * u + b * v
        distance = distances_of(standing, start, Vec(*np.array(normal))).min() - 9
        assert -1e-9 < distance < 0.03 * radius


def test_the_sky_and_the_far_ground_are_no_place_to_stand() -> None:
    """There an element is as far as what is looked at."""
    for y in (5, 108):
        state, ball = added(HEAD + GROUND + "sp 0,1,0 2 9,9,9\n", 600, y)
        assert state.aim is not None
        assert state.aim.normal is None
        assert dist(ball.balls()[0][0], state.scene.camera.position) == pytest.approx(state.size, rel=0.01)


def test_walls_and_ceilings_are_touched() -> None:
    ceiling = "A 0.2 255,255,255\nC 0,1,0 0,1,-1 60\npl 0,3,0 0,1,0 9,9,9\nsp 0,1,-3 0.5 9,9,9\n"
    _, ball = added(ceiling, 200, 60)
    assert isinstance(ball, Sphere)
    assert ball.centre[1] + ball.diameter / 2 == pytest.approx(3, abs=1e-3)
    wall = "A 0.2 255,255,255\nC 0,1,0 0,0,-1 60\npl 0,0,-5 0,0,-1 9,9,9\nsp 0,1,-3 0.5 9,9,9\n"
    _, box = added(wall, 100, 60, "bo")
    assert (box.bounds() or ((0,), (0,)))[0][2] == pytest.approx(-5, abs=1e-3)


def test_a_lamp_hangs_before_the_surface_that_it_is_aimed_at() -> None:
    state = aiming(initial_state(scene(HEAD.replace("L 5,9,5 0.6\n", "") + GROUND)), 200, 250)
    (kind,) = [each for each in addable_kinds(state.scene) if each.code == "L"]
    lamp = default_element(kind, state)
    x, y, z = lamp.position  # type: ignore[attr-defined]
    assert y > 0.5
    column, row = projection_of(state.scene.camera, *SIZE).pixel((x, 0.0, z))  # type: ignore[misc]
    assert hypot(column - 200.5, row - 250.5) < 5  # the ground below it


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.8, 1.2])
def test_clearance_above_a_ball_is_that_of_geometry(offset: float) -> None:
    """Two balls with a horizontal distance touch at a height that Pythagoras knows."""
    below, ball = Sphere((0, 0, 0), 2, RED), Sphere((offset, 7, 0), 1, RED)
    gap, support = clearance(ball, [below, Sphere((0, -5, 0), 2, RED), Sphere((0, 20, 0), 9, RED)])
    assert support is below
    assert gap == pytest.approx(7 - sqrt(1.5**2 - offset**2), abs=2e-3 if offset else 1e-9)


def test_a_shape_that_sinks_into_another_is_raised() -> None:
    around = Scene((scene().camera, Box(centre=(0, 1, 0), axis=(0, 1, 0), sizes=(4, 2, 4), colour=RED)))
    for height in (4.0, 2.2, 1.8):
        fallen = dropped(Sphere((1, height, 1), 1, RED), around, None)
        assert isinstance(fallen, Sphere)
        assert fallen.centre == pytest.approx((1, 2.5, 1))
    assert dropped(Sphere((9, -3, 1), 1, RED), around, 0.5) is None
    beside = dropped(Sphere((9.1, 3, 1.3), 1, RED), around, 0.5)
    assert beside is not None
    assert beside.balls()[0][0] == pytest.approx((9, 0.5, 1.5))
    near_middle = dropped(Sphere((0.3, 4, 0.2), 1, RED), around, 0.5)
    assert near_middle is not None
    assert near_middle.balls()[0][0] == pytest.approx((0, 2.5, 0))


def test_a_mesh_is_stood_on(tmp_path: Path) -> None:
    (tmp_path / "roof.obj").write_text("v -2 1 -2\nv 2 1 -2\nv 2 1 2\nv -2 1 2\nf 1 2 3\nf 1 3 4\n")
    path = tmp_path / "scene.rt"
    path.write_text(HEAD + "ob roof.obj 0,0,0 1 9,9,9\nsp 0.4,5,0.4 1 9,9,9\n")
    built = load(path).scene
    (mesh,), (ball,) = built.meshes, built.spheres
    gap, support = clearance(ball, [mesh])
    assert support is mesh
    top = (mesh.bounds() or ((), (0, 0, 0)))[1][1]
    assert gap == pytest.approx(4.5 - top)


def test_a_new_element_keeps_standing_while_its_size_changes_and_until_it_is_moved() -> None:
    state = adding(aiming(initial_state(scene(HEAD + GROUND)), 250, 240))
    for _ in range(5):
        state = apply(state, "grow").end_merging()
    ball = state.element
    assert isinstance(ball, Sphere)
    assert ball.centre[1] == pytest.approx(ball.diameter / 2, abs=1e-3)
    moved = apply(state, "up")
    larger = apply(moved, "grow").element
    assert larger.replace(diameter=ball.diameter) == moved.element
    other = apply(apply(state, "duplicate"), "grow").element
    assert isinstance(other, Sphere)
    assert other.centre[1] == pytest.approx(other.diameter / 2, abs=1e-3)
    assert (other.centre[0] > ball.centre[0], other.centre[2]) == (True, ball.centre[2])


def test_drop_is_one_undo_step_and_says_where_nothing_can_fall() -> None:
    start = initial_state(scene(HEAD + GROUND + "sp 1.23,4,-0.77 1 9,9,9\n"))
    state = start.select(len(start.scene.elements) - 1)
    fallen = apply(state, "drop")
    assert isinstance(fallen.element, Sphere)
    assert fallen.element.centre[1] == pytest.approx(0.5)
    assert all(abs(part / state.stride - round(part / state.stride)) < 1e-9 for part in fallen.element.centre[::2])
    assert apply(fallen, "undo").scene.items == start.scene.items
    for index in (2, 3):  # a light, a plane
        assert "cannot stand" in apply(start.select(index), "drop").message


@pytest.mark.parametrize(
    ("position", "direction", "distance"),
    [
        ((0, 2, 9), (0, -0.6, -0.8), 2 / 0.6),  # to the ground
        ((0, 2, -9), (0, 0, 1), 9),  # level: to where it is nearest to the origin
        ((0, 0, 0), (0, 0, 1), 10),
        ((3, 4, 0), (0, 0, 1), 5),  # past it
        ((0, 3, 0), (0, 1, 0), 3),  # away
    ],
)
def test_the_camera_alone_tells_a_scale(position: Triple, direction: Triple, distance: float) -> None:
    camera = scene().camera.replace(position=position, direction=direction)
    assert looked_at_distance(camera) == pytest.approx(distance)


# The list of kinds.


def adding(state: State, number: int = 1) -> State:
    """The state after an element was added: the first of the list, or the one with that number."""
    return list(choices(state, ELEMENT))[number - 1][1]


def test_shapes_come_first_and_what_a_scene_has_once_is_not_added_again() -> None:
    kinds = addable_kinds(scene(BARE))
    assert kinds[: len(KINDS)] == [kind.element for kind in KINDS]
    assert ELEMENTS["L"] in kinds
    assert ELEMENTS["L"] not in addable_kinds(scene())


def test_undo_restores_the_selection() -> None:
    state = apply(initial_state(scene()), "select light")
    undone = apply(adding(state, 4), "undo")
    assert undone.element == state.element
    assert apply(undone, "redo").element == adding(state, 4).element

"""Rotations by keys and drags turn the whole frame of a shape, against matrices, and are written neatly."""

from __future__ import annotations

import re
from math import asin, atan, degrees, dist, tan

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.element import Element
from minirt.fields.scalars import FARTHEST, LEAST_LENGTH
from minirt.materials import Checker
from minirt.rendering.packing.camera import camera_frame
from minirt.scene import Camera, Scene, describe, dump, parse
from minirt.shapes import Box, Cylinder, Ellipsoid, Plane, Sphere, Square, Torus
from minirt.shapes.shape import Flat, Oriented
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.projection import scene_size
from minirt.viewer.editing.rigid import rotate
from minirt.viewer.editing.state import State, initial_state
from minirt.viewer.editing.values import round_changes, values
from tests.reference.uv_mapping import right_and_up_on
from tests.reference.vectors import own_x_and_z
from tests.viewer.fake import scene

Matrix = NDArray[np.float64]
GREY, BOARD = (200, 200, 200), Checker(0.125)
UP, ORIGIN = (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)
LEVEL = Camera((0, 0, -10), (0, 0, 1), 60)
BLOCK = Box(ORIGIN, UP, (1, 2, 3), GREY)
TILE = Square(ORIGIN, UP, 2, GREY)
SHAPES = (
    BLOCK,
    TILE,
    Ellipsoid(ORIGIN, (0.0, -1.0, 0.0), (1, 2, 3), GREY),
    Sphere(ORIGIN, 2, GREY, checker=BOARD),
    Plane(ORIGIN, (0, 0, -1), GREY, checker=BOARD),
    Cylinder(ORIGIN, (1, 0, 0), 1, 2, GREY, checker=BOARD),
    Torus(ORIGIN, (0.6, 0, 0.8), 3, 1, GREY, checker=BOARD),
)
NUMBER = re.compile(r"-?[0-9.]+(?:e[-+]?[0-9]+)?")
HEAD = "A 0 0,0,0\nC 0,0,10 0,0,-1 60\n"


def selecting(shape: Element, camera: Camera = LEVEL) -> State:
    """The state with a shape selected, in front of a camera."""
    return initial_state(Scene([camera, shape])).select(1)


def after(state: State, *actions: str) -> State:
    """The state after some actions, each saved and read back."""
    for action in actions:
        state = apply(state, action)
        assert parse(f"A 0 0,0,0\n{dump(state.scene)}").scene.elements[1:] == tuple(state.scene.elements)
    return state


def axes(shape: Element) -> Matrix:
    """The own axes of a shape as columns, by the formulas of the reference renderer."""
    assert isinstance(shape, Oriented)
    if isinstance(shape, Flat):
        return np.stack([*right_and_up_on(shape), np.array(shape.normal)], axis=1)  # type: ignore[arg-type]
    y = np.array(shape.axis)  # type: ignore[attr-defined]
    x, z = own_x_and_z(y, shape.roll)
    return np.stack([x, y, z], axis=1)


def quaternion_rotation(about: tuple[float, float, float], degrees: float) -> Matrix:
    """The matrix of a rotation, from the products of a unit quaternion (Hamilton)."""
    half = np.radians(degrees) / 2
    w, (x, y, z) = np.cos(half), np.sin(half) * np.array(about)
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )


def largest_error(shape: Element) -> float:
    """The largest error of the own axes of a shape after each of 60 random rotations, which are rounded as keys do."""
    random = np.random.default_rng(3)
    right, worst = axes(shape), 0.0
    for _ in range(60):
        along = np.eye(3)[random.integers(3)] * random.choice([-1, 1])
        v = along if random.random() < 0.5 else random.normal(size=3)
        about = tuple((v / np.linalg.norm(v)).tolist())
        angle = float(random.choice([5, -5, 0.5, 90, 180, 37.3]))
        shape = round_changes(shape, rotate(shape, about, angle), 1.0)
        right = quaternion_rotation(about, angle) @ right
        worst = max(worst, float(np.abs(axes(shape) - right).max()))
    return worst


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.title)
def test_rotations_compose_as_matrices_do(shape: Element) -> None:
    assert largest_error(shape) < 1e-6


@pytest.mark.parametrize("down", [0.0, -0.1, -1.0])
@pytest.mark.parametrize("shape", [BLOCK, TILE], ids=lambda shape: shape.title)
def test_an_upright_shape_is_yawed_by_exactly_the_angle(shape: Element, down: float) -> None:
    state = after(selecting(shape, LEVEL.replace(direction=(0, down, 1))), *["turn right"] * 7)
    assert state.element == shape.replace(roll=35.0)
    assert after(state, *["turn left"] * 7).element == shape
    assert after(state, "undo").element == shape  # steps in quick succession are undone together


def test_a_leaning_shape_keeps_its_slope_when_it_is_yawed() -> None:
    leaning = BLOCK.replace(axis=(0.6, 0.8, 0), roll=10.0)
    turned = after(selecting(leaning), "turn right").element
    assert turned.axis == pytest.approx((0.6 * np.cos(np.radians(5)), 0.8, -0.6 * np.sin(np.radians(5))), abs=1e-9)
    assert turned.roll == 15.0


def test_a_camera_that_looks_down_turns_shapes_about_its_own_up() -> None:
    camera = LEVEL.replace(direction=(0, -1, 0.2))
    turned = after(selecting(BLOCK, camera), "turn right").element
    right = quaternion_rotation(camera_frame(camera)[1], 5) @ axes(BLOCK)
    assert axes(turned) == pytest.approx(right, abs=1e-7)


def test_comma_and_point_roll_what_faces_the_camera() -> None:
    board = Square(ORIGIN, (0, 0, -1), 2, GREY)
    clockwise = after(selecting(board), "roll right")
    assert clockwise.element == board.replace(roll=-5.0)
    assert after(clockwise, "roll left", "roll left").element == board.replace(roll=5.0)


@pytest.mark.parametrize("shape", [BLOCK, TILE, SHAPES[3]], ids=lambda shape: shape.title)
def test_turns_there_and_back_leave_no_trace(shape: Element) -> None:
    there = ["turn up"] * 7 + ["roll right"] * 4 + ["turn left"] * 5
    back = ["turn right"] * 5 + ["roll left"] * 4 + ["turn down"] * 7
    assert describe(after(selecting(shape), *there, *back).element) == describe(shape)


def test_directions_and_turns_have_at_most_nine_digits_and_no_exponent() -> None:
    actions = ["turn up", "roll right", "turn left", "turn up", "turn down"] * 5
    for element in (*SHAPES, LEVEL):
        state = selecting(element) if element is not LEVEL else initial_state(Scene([LEVEL, BLOCK]))
        for action in actions:
            state = after(state, action)
            for number in NUMBER.findall(describe(state.element)):
                assert "e" not in number
                assert len(number.strip("-").replace(".", "").strip("0")) <= 9, describe(state.element)
    up = after(initial_state(Scene([LEVEL.replace(direction=(0.3, 0, 1)), BLOCK])), *["turn up"] * 20)
    assert "e" not in describe(up.element)
    assert up.element.direction[1] == 1


def test_an_unedited_direction_keeps_its_text() -> None:
    text = "A 0.2 255,255,255\nC 0,0,-10 0,0,1 60\nbo 0,0,0 6.12254680112596e-17,1.0,0.01498139507648616 1,2,3 9,9,9\n"
    state = initial_state(parse(text).scene).select(2)
    moved = dump(apply(state, "right").scene)
    assert "6.12254680112596e-17,1.0,0.01498139507648616" in moved
    turned = dump(apply(state, "turn up").scene).splitlines()[2].split()
    assert turned[2].split(",")[0] == "0"
    assert all(len(part) <= 12 for part in turned[2].split(","))


def test_a_shape_that_looks_the_same_is_not_turned() -> None:
    pole = Cylinder(ORIGIN, UP, 1, 2, GREY)
    state = after(selecting(pole), "turn right")
    assert state.element == pole
    assert "looks the same after a turn about its own axis" in state.message
    assert after(selecting(pole.replace(checker=BOARD)), "turn right").element.roll == 5.0
    plain = Sphere(ORIGIN, 2, GREY)
    assert "same from all sides" in after(selecting(plain), "turn up").message
    globe = plain.replace(checker=BOARD)
    assert after(selecting(globe), "turn right").element == globe.replace(roll=5.0)
    for shape, listed in ((pole, False), (pole.replace(checker=BOARD), True), (plain, False), (globe, True)):
        assert ("roll" in {value.name for value in values(shape)}) == listed
    assert "roll" in {value.name for value in values(BLOCK)}


# Sizes of scenes, and positions of the camera that frame an element.


@pytest.mark.parametrize(
    ("lines", "size"),
    [
        ("", 10),  # to the point that is nearest to the origin
        ("sp 0,0,0 2 9,9,9", 10),
        ("sp 0,0,10 2 9,9,9", 1),  # the camera is in its centre
        ("sp 0,0,0 2 9,9,9\nsp 0,0,1 2 9,9,9\nsp 0,0,0 1e9 9,9,9", 10),  # with a sky
        ("sp 0,0,0 2 9,9,9\npl 0,-1e6,0 0,1,0 9,9,9", 10),  # a plane is unbounded
        ("pl 0,0,6 0,1,0 9,9,9", 4),
        ("L 3,0,14 1", 5),
        ("sp 0,0,9.999999 1e-9 9,9,9", 1e-6),
        ("sp 1e15,0,0 1 9,9,9", FARTHEST),
        ("pl 0,0,10 0,1,0 9,9,9", 10),
        ("sp 0,0,10 1e-30 9,9,9", LEAST_LENGTH),
    ],
)
def test_the_size_of_a_scene_is_the_median_distance(lines, size):
    assert scene_size(scene(HEAD + lines + "\n")) == pytest.approx(size)


@pytest.mark.parametrize("fov", [1, 60, 120])
def test_look_at_fits_a_sphere_to_a_usual_window(fov):
    text = f"A 0 0,0,0\nC 50,2,9 0.6,0,0.8 {fov}\nsp 1,2,3 4 9,9,9\n"
    state = apply(apply(initial_state(scene(text)), "select next"), "look at")
    position = state.scene.camera.position
    distance = dist(position, (1, 2, 3))
    assert position == pytest.approx((1 - 0.6 * distance, 2, 3 - 0.8 * distance), abs=1e-5)
    share = tan(asin(2 / distance)) / tan(atan(tan(fov / 2 * 3.141592653589793 / 180) * 9 / 16))
    assert 0.3 < share < 1, degrees(asin(2 / distance))


def test_look_at_moves_near_to_a_light():
    state = apply(apply(initial_state(scene(HEAD + "L 3,0,-1000 1\nsp 0,0,0 1 9,9,9\n")), "select next"), "look at")
    assert 0 < dist(state.scene.camera.position, (3, 0, -1000)) < 10

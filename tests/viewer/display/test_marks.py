"""Marks: positions of outline, axis and icons in the frame, and an unchanged picture below them."""

from __future__ import annotations

from math import cos, hypot, radians, sin
from typing import Any

import numpy as np
import pytest

from minirt.fields import Triple
from minirt.rendering.packing.ray_casting import camera_ray, distances_of
from minirt.rendering.queries.pick import covers
from minirt.scene import Camera
from minirt.shapes import Mesh, Shape, Torus
from minirt.shapes import torus as torus_formulas
from minirt.viewer.display import outline
from minirt.viewer.display.marks import (
    AXIS_COLOURS,
    BLACK,
    BORDER,
    GOLD,
    MOVING_RAYS,
    TOP,
    WHITE,
    Icon,
    arrow_direction,
    bgra,
    draw_arrow,
    draw_icon,
    draw_line,
    draw_outline,
    visible_icons,
)
from minirt.viewer.display.outline import outline_pixels
from minirt.viewer.editing.projection import projection_of
from minirt.viewer.editing.state import MoveAxes
from tests.meshes.examples import first_hits, named
from tests.random_scenes import random_scene
from tests.viewer.fake import TEXT, colour_of, played, scene

WIDTH, HEIGHT = 160, 90
GOLDEN = np.array(bgra(GOLD), np.uint8)
VIEW = projection_of(scene().camera, 320, 180)  # from 0,0,10 along -z, field of view 90 degrees


def edges(shape: Shape, camera: Camera, width: int = WIDTH, height: int = HEIGHT) -> tuple[np.ndarray, np.ndarray]:
    """Return masks of the pixels just outside and just inside a shape, from the distance at every pixel."""
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    origin, direction = camera_ray(camera, width, height, x, y)
    if isinstance(shape, Mesh):
        directions = np.stack([direction.x, direction.y, direction.z], axis=-1).reshape(-1, 3)
        corners = shape.rows()[:, :9].reshape(-1, 3, 3)
        distances = first_hits(corners, np.broadcast_to(camera.position, directions.shape), directions)[0]
        mask = np.isfinite(distances).reshape(height, width)
    else:
        mask = np.isfinite(distances_of(shape, origin, direction))
    framed = np.pad(mask, 1, mode="edge")
    around = framed[:-2, 1:-1], framed[2:, 1:-1], framed[1:-1, :-2], framed[1:-1, 2:]
    return np.logical_or.reduce(around) & ~mask, mask & ~np.logical_and.reduce(around)


def mask_of(places: tuple[np.ndarray, np.ndarray], width: int = WIDTH, height: int = HEIGHT) -> np.ndarray:
    """Return a mask that is true at these pixels."""
    mask = np.zeros((height, width), bool)
    mask[places] = True
    return mask


@pytest.mark.parametrize("seed", range(8))
def test_an_outline_is_where_the_shape_ends(seed: int) -> None:
    scene = random_scene(seed)
    for shape in scene.shapes:
        found = outline_pixels(shape, scene.camera, WIDTH, HEIGHT, 10**6)
        for pixels, expected in zip(found, edges(shape, scene.camera), strict=True):
            assert np.array_equal(mask_of(pixels), expected)


@pytest.mark.parametrize(("name", "size"), [("icosahedron", (WIDTH, HEIGHT)), ("knot", (48, 27))])
def test_the_outline_of_a_mesh_is_its_silhouette(name: str, size: tuple[int, int]) -> None:
    shape, camera = named(name, (0.5, 0.2, 0), 2.0), Camera((1, 2, -6), (-0.1, -0.3, 0.9), 70)
    for found, known in zip(outline_pixels(shape, camera, *size, 100), edges(shape, camera, *size), strict=True):
        assert np.array_equal(mask_of(found, *size), known)
        assert known.sum() > 40


def test_few_rays_find_most_of_the_outline() -> None:
    known = found = 0
    for seed in range(8):
        scene = random_scene(seed)
        for shape in scene.shapes:
            outside, _ = edges(shape, scene.camera)
            known += outside.sum()
            found += (mask_of(outline_pixels(shape, scene.camera, WIDTH, HEIGHT, 300)[0]) & outside).sum()
    assert found > 0.9 * known > 0


def test_an_outline_takes_few_rays_and_no_distances(monkeypatch: pytest.MonkeyPatch) -> None:
    torus, rays = Torus((0, 0, 0), (0, 0.6, 0.8), 4, 1, (9, 9, 9)), list[int]()

    def counted(*args: Any) -> Any:
        rays.append(np.broadcast(*args[-2:]).size)
        return covers(*args)

    monkeypatch.setattr(outline, "covers", counted)
    monkeypatch.setattr(torus_formulas, "crossing", None)
    outside, _ = outline_pixels(torus, Camera((0, 0, -5), (0, 0, 1), 60), 1920, 1080, MOVING_RAYS)
    assert len(outside[0]) > 3000
    assert sum(rays) < 8 * MOVING_RAYS


def golden(session) -> np.ndarray:
    """Return a mask of the pixels in the colour of the outline."""
    return (session.screen.frame == GOLDEN).all(axis=2)


def test_the_outline_is_drawn_in_the_frame_but_not_in_the_picture() -> None:
    session = played("resize 160x90", "click 82,44")
    assert session.state.element.title == "sphere"
    outside, _ = edges(session.state.element, session.state.scene.camera)
    assert golden(session)[outside][40:].all()  # below the line of the HUD
    assert (session.picture == colour_of(session.state.scene)).all()
    assert not golden(played("resize 160x90", "click 82,44", "press C")).any()
    assert not golden(played("resize 160x90", "click 82,44", "press I", "press I")).any()


@pytest.mark.parametrize("corner", [0, 3])
def test_an_outline_has_black_beside_it_and_none_beyond_a_corner_of_the_picture(corner: int) -> None:
    pixels, inward = np.full((4, 4, 4), 9, np.uint8), 1 if corner == 0 else -1
    row, rows = np.array([corner]), np.array([corner + inward])
    draw_outline(pixels, (row, row), (rows, row), GOLD)
    black = np.zeros((4, 4), bool)
    black[[corner, corner + inward, corner + 2 * inward], [corner + inward, corner + inward, corner]] = True
    assert ((pixels == np.array(bgra(BLACK), np.uint8)).all(axis=2) == black).all()
    assert (pixels[[corner, corner + inward], corner] == GOLDEN).all()


@pytest.mark.parametrize(("presses", "frame"), [(1, MoveAxes.X), (2, MoveAxes.Y), (3, MoveAxes.Z)])
def test_the_movement_axis_passes_through_the_element(presses: int, frame: MoveAxes) -> None:
    text = "A 0 0,0,0\nC 5,4,10 -0.5,-0.4,-1 60\nsp 0,0,0 0.1 9,9,9\n"
    session = played("resize 160x120", "press Tab", *["press X"] * presses, text=text)
    coloured = (session.screen.frame == np.array(bgra(AXIS_COLOURS[frame]), np.uint8)).all(axis=2)
    seen = projection_of(session.state.scene.camera, 160, 120)
    for reach in (-1, 1):
        point = (reach * (frame is MoveAxes.X), reach * (frame is MoveAxes.Y), reach * (frame is MoveAxes.Z))
        x, y = seen.pixel(point)
        assert coloured[round(y) - 2 : round(y) + 3, round(x) - 2 : round(x) + 3].any()
    camera = played("resize 160x120", *["press X"] * presses, text=text).screen.frame
    assert not (camera == np.array(bgra(AXIS_COLOURS[frame]), np.uint8)).all(axis=2).any()


@pytest.mark.parametrize(
    ("start", "end", "rows", "columns"),
    [
        ((2, 0), (9, 0), (0, 2), (2, 10)),
        ((2, 19), (9, 19), (19, 20), (2, 10)),
        ((0, 2), (0, 9), (2, 10), (0, 2)),
        ((29, 2), (29, 9), (2, 10), (29, 30)),
    ],
)
def test_lines_are_two_pixels_wide_but_at_the_last_row_and_column(start, end, rows, columns) -> None:
    pixels, expected = np.zeros((20, 30, 4), np.uint8), np.zeros((20, 30), bool)
    draw_line(pixels, start, end, 0xFFFFFF)
    expected[slice(*rows), slice(*columns)] = True
    assert np.array_equal(pixels.any(axis=2), expected)


def test_lights_have_icons_that_can_be_clicked() -> None:
    text = TEXT.replace("L 5,5,5", "L 2,2,5")
    hidden, shown = played("resize 300x200", text=text), played("resize 300x200", "press G", text=text)
    assert not np.array_equal(hidden.screen.frame, shown.screen.frame)
    state = shown.state
    placed = visible_icons(state.scene, (), projection_of(state.scene.camera, 300, 200), 1.0, every=True)
    assert sorted(icon.code for icon in placed) == ["A", "C", "L"]
    for icon in placed:
        keys = ["resize 300x200", "press Tab", "press Tab", "press G", f"click {icon.x},{icon.y}"]
        clicked = played(*keys, text=text).state
        assert clicked.element.code == icon.code
    (light,) = [icon for icon in placed if icon.code == "L"]
    assert played("resize 300x200", f"click {light.x},{light.y}", text=text).state.element.code != "L"
    drag = f"drag {light.x},{light.y} {light.x - 20},{light.y}"
    moved = played("resize 300x200", "press G", drag, text=text).state.scene
    seen = projection_of(moved.camera, 300, 200)
    assert seen.pixel(moved.lights[0].position) == pytest.approx((light.x - 20, light.y), abs=1)


def test_a_further_camera_has_an_icon_that_can_be_dragged_unless_it_is_in_view() -> None:
    text = TEXT + "c 2,2,5 0,0,-1 50\n"
    state = played("resize 300x200", text=text).state
    for seen, codes in ((state.scene, ["A", "C", "c"]), (state.scene.seen_by(2), ["A", "c"])):
        view = projection_of(seen.camera, 300, 200)
        placed = visible_icons(seen, (), view, 1.0, every=True)
        assert sorted(icon.code for icon in placed) == codes
    (icon,) = [
        icon
        for icon in visible_icons(state.scene, (), projection_of(state.scene.camera, 300, 200), 1.0, True)
        if icon.code == "c"
    ]
    drag = f"drag {icon.x},{icon.y} {icon.x - 20},{icon.y}"
    moved = played("resize 300x200", "press G", drag, text=text).state.scene
    assert moved.camera == state.scene.camera
    seen = projection_of(moved.camera, 300, 200)
    assert seen.pixel(moved.cameras[1].position) == pytest.approx((icon.x - 20, icon.y), abs=1)


def test_an_icon_has_the_colour_of_its_light() -> None:
    text = "A 0 0,0,0\nC 0,0,0 0,0,1 70\nL 0,0,5 1 255,128,1\nc 0,0,9 0,0,1 70\n"
    view = projection_of(scene(text).camera, 300, 200)
    icons = visible_icons(scene(text), frozenset(), view, 1.0, every=True)
    assert {icon.code: icon.colour for icon in icons}.items() >= {"L": 0xFFFF8001, "c": 0xFFFFFFFF}.items()


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_an_icon_is_a_square_with_a_frame(scale: float) -> None:
    pixels = np.full((100, 100, 4), 9, np.uint8)
    draw_icon(pixels, Icon(0, 50, 50, "L", 0xFF123456), scale, GOLD)
    for of_square, side in ((pixels != 9).any(axis=2), 24), (~framed(pixels), 20):
        rows, columns = np.nonzero(of_square)
        assert (np.ptp(rows) + 1, np.ptp(columns) + 1) == (side * scale, side * scale)


def framed(pixels: np.ndarray) -> np.ndarray:
    """Return a mask of the pixels that are golden or untouched."""
    return (pixels == GOLDEN).all(axis=2) | (pixels == 9).all(axis=2)


@pytest.mark.parametrize(("colour", "letters"), [(0x0050FB, BLACK), (0x0050F9, WHITE), (0xFB5000, BLACK), (0, WHITE)])
def test_letters_are_black_on_bright_icons(colour: int, letters: int) -> None:
    pixels = np.zeros((40, 40, 4), np.uint8)
    draw_icon(pixels, Icon(0, 20, 20, "L", BLACK | colour), 1.0, GOLD)
    drawn = {tuple(each) for each in pixels[10:30, 10:30].reshape(-1, 4).tolist()}
    assert bgra(letters) in drawn
    assert bgra(BLACK ^ WHITE ^ letters | BLACK) not in drawn - {bgra(BLACK | colour)}


# Arrows at the edge of the picture point to selected elements outside of it.


@pytest.mark.parametrize(
    ("point", "direction"),
    [
        ((0, 0, 0), None),
        ((9, 0, 0), None),
        ((11, 0, 0), (1, 0)),
        ((-11, 0, 0), (-1, 0)),
        ((0, 9, 0), (0, -1)),
        ((0, -9, 0), (0, 1)),
        ((30, 40, 0), (0.6, -0.8)),
        ((3, -4, 20), (0.6, 0.8)),  # behind the eye: the way to turn
        ((0, 0, 20), (0, 1)),
    ],
)
def test_an_arrow_points_to_where_the_camera_has_to_turn(point: Triple, direction: tuple[float, float] | None) -> None:
    found = arrow_direction(VIEW, point)
    assert found == (None if direction is None else pytest.approx(direction))


def test_a_ball_that_reaches_into_the_picture_needs_no_arrow() -> None:
    assert arrow_direction(VIEW, (11, 0, 0), radius=0.5)
    assert arrow_direction(VIEW, (11, 0, 0), radius=1.5) is None
    assert arrow_direction(VIEW, (0, 0, 11), radius=2.0) is None  # around the eye


@pytest.mark.parametrize("degrees", range(0, 360, 15))
@pytest.mark.parametrize("size", [(320, 180), (60, 200)])
def test_an_arrow_lies_within_the_picture_near_its_edge(degrees: int, size: tuple[int, int]) -> None:
    direction = cos(radians(degrees)), sin(radians(degrees))
    pixels = np.zeros((size[1], size[0], 4), np.uint8)
    draw_arrow(pixels, direction, 1.0)
    rows, columns = np.nonzero((pixels == GOLDEN).all(axis=2))
    assert 100 < len(rows) < 250
    top = min(TOP, size[1] / 4)
    middle = columns.mean() + 0.5 - size[0] / 2, rows.mean() + 0.5 - (size[1] + top - BORDER) / 2
    assert np.dot(middle, direction) / hypot(*middle) > 0.98
    edge = min(rows.min() - top, columns.min(), size[1] - 1 - rows.max(), size[0] - 1 - columns.max())
    assert -1 <= edge < 16


def test_a_selected_lamp_outside_of_the_picture_has_an_arrow() -> None:
    def golden(*lines: str) -> int:
        frame = played("resize 320x180", *lines).screen.frame
        return int((frame == GOLDEN).all(axis=2).sum())

    assert golden("press L") > 100
    assert golden("press C") == 0
    assert golden("press L", "press F", "press L") != golden("press L")

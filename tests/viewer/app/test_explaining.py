"""A pixel is explained over the picture: rays where they are in the scene, and their numbers; and views of buffers."""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.viewer.app.session import Session
from minirt.viewer.display import tool_row
from minirt.viewer.display.explained import (
    FREE,
    SHADOWED,
    Explained,
    clipped,
    draw_explained,
    draw_soft_line,
    explained,
)
from minirt.viewer.display.lists import layout_of
from minirt.viewer.display.views import VIEWS, view_pixels
from minirt.viewer.editing.projection import projection_of
from tests.viewer.app.test_lists import SIZE_OF_WINDOW as SIZE
from tests.viewer.app.test_lists import clicked, play, right_click
from tests.viewer.fake import played, scene

MIDDLE = "move 320,240"  # of the window of recorded keys: on the sphere


def shown(session: Session) -> Explained:
    """Return the pixel that a window explains."""
    assert session.screen.explained
    return session.screen.explained


def test_a_key_explains_the_pixel_under_the_pointer_and_hides_it_again() -> None:
    after = play(MIDDLE, "press Y")
    assert shown(after).explanation == minirt.explain(scene(), *SIZE, 320, 240)
    assert "point" in after.state.message
    assert play(MIDDLE, "press Y", "press Y").screen.explained is None
    other = shown(play(MIDDLE, "press Y", "move 1,1", "press Y")).explanation
    assert (other.x, other.y) == (1, 1)


def test_the_list_of_the_right_click_explains_the_pixel_where_it_was_asked_for() -> None:
    after = clicked(right_click((330, 250)), row="explain this pixel")
    assert (shown(after).explanation.x, shown(after).explanation.y) == (330, 250)


def test_a_click_on_a_row_shows_its_numbers_and_edits_nothing() -> None:
    before = play(MIDDLE, "press Y")
    box = shown(before).box(before.screen.scale)
    assert len(box.rows) == 2  # the ray, and that to the light
    at = layout_of(box, *SIZE, before.screen.text_size)
    on_list = f"{at.text_left},{at.rows_top + at.line + 2}"
    for lines in ([f"click {on_list}"], [f"move {on_list}", "wheel down 3"]):
        after = play(MIDDLE, "press Y", *lines)
        assert shown(after).chosen == 1
        assert after.state.message == shown(after).parts[1].details
        assert "cosine" in after.state.message
        assert after.state.selected == before.state.selected
        assert after.state.scene.camera == before.state.scene.camera


@pytest.mark.parametrize("x", [250, 390])  # both on the sphere
def test_the_list_leaves_the_pixel_and_the_tool_row_free(x: int) -> None:
    screen = play(f"move {x},240", "press Y").screen
    assert screen.explained
    at = layout_of(screen.explained.box(screen.scale), *SIZE, screen.text_size)
    assert not at.left <= x < at.right
    assert (tool_row.SIDE * screen.scale <= at.left, at.right <= SIZE[0]) == (True, True)


def test_rays_stay_while_the_camera_moves_and_go_with_the_shapes_that_they_met() -> None:
    moved = play(MIDDLE, "press Y", "press D", "press Left")
    assert moved.state.scene.camera != scene().camera
    assert shown(moved).fits(moved.state.scene)
    edited = play(MIDDLE, "press Y", "press Tab", "press D")
    assert not shown(edited).fits(edited.state.scene)


def seen_of(shape: minirt.Shape, *more: minirt.Shape) -> tuple[Explained, minirt.Scene]:
    """Explain the middle of a picture, seen from aside then: the scene has another camera."""
    lamp, camera = minirt.Light((0, 3, 0), 0.5), minirt.Camera((0, 0, 0), (0, 0, 1), 60)
    made = minirt.Scene([minirt.Ambient(0.2, (255, 255, 255)), camera, lamp, shape, *more])
    return explained(minirt.explain(made, *SIZE, 320, 240), made), made.replace(
        camera, position=(-8, 1, 2), direction=(1, 0, 0)
    )


@pytest.mark.parametrize("is_dark", [False, True])
def test_rays_are_drawn_in_the_colours_of_their_kinds_where_the_camera_sees_them(is_dark: bool) -> None:
    ball = minirt.Sphere((0, 0, 5), 2, (200, 100, 50))
    between = [minirt.Sphere((0, 1.5, 2), 0.5, (255, 255, 255))] if is_dark else []
    rays, aside = seen_of(ball, *between)
    first, to_light = rays.parts
    assert first.end == pytest.approx((0, 0, 4), abs=0.01)
    share = 0.45 if is_dark else 1.0  # up to what casts the shadow
    assert to_light.end == pytest.approx((0, 3 * share, 4 - 4 * share), abs=0.01)
    pixels = np.zeros((480, 640, 4), np.uint8)
    draw_explained(pixels, rays._replace(chosen=1), aside, 1.0)
    half_way = projection_of(aside.camera, *SIZE).pixel((0, 1.5 * share, 4 - 2 * share))
    assert half_way
    x, y = map(int, half_way)
    assert tuple(pixels[y, x, 2::-1]) == (SHADOWED if is_dark else FREE)
    before = projection_of(aside.camera, *SIZE).pixel((0, 0, 2))
    assert before is not None
    across, down = map(int, before)
    around = pixels[down - 1 : down + 2, across - 1 : across + 2, :3]
    assert around.min(axis=-1).max() > 200  # white
    assert not pixels[470].any()


def test_nothing_is_drawn_over_a_picture_of_other_shapes() -> None:
    rays, aside = seen_of(minirt.Sphere((0, 0, 5), 2, (200, 100, 50)))
    pixels = np.zeros((480, 640, 4), np.uint8)
    draw_explained(pixels, rays, aside.replace(aside.spheres[0], diameter=3), 1.0)
    assert not pixels.any()


@pytest.mark.parametrize(
    ("start", "end", "expected"),
    [
        ((-10, 5), (30, 5), ((0, 5), (20, 5))),
        ((5, -1e9), (5, 1e9), ((5, 0), (5, 10))),
        ((-10, -10), (-1, 50), None),
        ((3, 20), (8, 20), None),
        ((2, 3), (4, 5), ((2, 3), (4, 5))),
        ((-10, 15), (15, -10), ((0, 5), (5, 0))),
    ],
)
def test_a_line_is_clipped_to_the_picture(start, end, expected) -> None:
    found = clipped(start, end, 20, 10)
    assert (found is None) == (expected is None)
    if found:
        assert np.allclose(found, expected, atol=1e-6)


@pytest.mark.parametrize("ends", [((2, 10), (38, 10)), ((20, 2), (20, 18)), ((38, 18), (2, 2)), ((2, 18), (12, 2))])
def test_a_soft_line_covers_as_much_as_it_is_long_and_wide(ends) -> None:
    pixels = np.zeros((20, 40, 4), np.uint8)
    draw_soft_line(pixels, *ends, (255, 255, 255), 3.0, 1.0)
    length = np.hypot(*np.subtract(*ends))
    assert pixels[..., 0].sum() / 255 == pytest.approx(3.0 * length, rel=0.15)
    assert (pixels[..., 3] == 0).all()


@pytest.mark.parametrize("presses", range(5))
def test_a_key_goes_through_the_views_and_back_to_colours(presses: int) -> None:
    session = played(*["press O"] * presses)
    latest = session.refinement.latest
    assert latest
    view = VIEWS[presses % 4]
    assert (latest.job.view, latest.is_final) == (view, True)
    if view:
        expected = view_pixels(scene(), view, session.window.width, session.window.height)
        assert np.array_equal(latest.pixels, expected)


def test_a_view_follows_the_camera() -> None:
    session = played("press O", "hold D 0.2")
    latest = session.refinement.latest
    assert latest
    assert latest.job.scene is session.state.scene
    assert np.array_equal(latest.pixels, view_pixels(session.state.scene, "normals", *latest.pixels.shape[1::-1]))


def test_a_view_that_is_not_wanted_any_more_is_not_made() -> None:
    assert view_pixels(scene(), "depth", 64, 48, lambda: False) is None

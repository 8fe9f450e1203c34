"""Arrows at the edge of the picture point to selected elements outside of it."""

from __future__ import annotations

from math import cos, hypot, radians, sin

import numpy as np
import pytest

from minirt.fields import Triple
from minirt.viewer.display.marks import BORDER, FILL, TOP, arrow_direction, draw_arrow
from minirt.viewer.editing.projection import projection_of
from tests.viewer.fake import played, scene

VIEW = projection_of(scene().camera, 320, 180)  # from 0,0,10 along -z, field of view 90 degrees


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
    rows, columns = np.nonzero((pixels == FILL).all(axis=2))
    assert 100 < len(rows) < 250
    top = min(TOP, size[1] / 4)
    middle = columns.mean() + 0.5 - size[0] / 2, rows.mean() + 0.5 - (size[1] + top - BORDER) / 2
    assert np.dot(middle, direction) / hypot(*middle) > 0.98
    edge = min(rows.min() - top, columns.min(), size[1] - 1 - rows.max(), size[0] - 1 - columns.max())
    assert -1 <= edge < 16


def test_a_selected_lamp_outside_of_the_picture_has_an_arrow() -> None:
    def golden(*lines: str) -> int:
        frame = played("resize 320x180", *lines).screen.frame
        return int((frame == FILL).all(axis=2).sum())

    assert golden("press L") > 100
    assert golden("press C") == 0
    assert golden("press L", "press F", "press L") != golden("press L")

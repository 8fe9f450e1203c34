"""Labels cover neither each other nor marks."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from minirt.report.output.labels import Box, Placer, overlaps

FRAME = Box(0, 0, 400, 300)


def covers(one: Box, other: Box) -> bool:
    return bool(overlaps(np.array([one]), [other])[0])


@pytest.mark.parametrize("seed", range(20))
def test_labels_cover_neither_labels_nor_marks_and_stay_inside(seed: int) -> None:
    random, placer = np.random.default_rng(seed), Placer(FRAME)
    points = [(float(x), float(y)) for x, y in random.uniform((10, 10), (390, 290), (40, 2))]
    for point in points:
        placer.take(point, 5.0)
    marks = list(placer.taken)
    placed = [placer.place("word" * (1 + index % 3), 12.0, [point], (8.0, 20.0)) for index, point in enumerate(points)]
    boxes = [each.box for each in placed if each]
    assert len(boxes) > 15
    assert not any(covers(one, other) for one, other in combinations(boxes, 2))
    assert not any(covers(box, mark) for box in boxes for mark in marks)
    assert all(box.left >= 0 and box.top >= 0 and box.right <= 400 and box.bottom <= 300 for box in boxes)


def test_a_label_goes_where_no_line_is() -> None:
    """A free label stands right above its point; a line there sends it elsewhere."""
    point, line = (200.0, 150.0), [(205.0, 140.0), (260.0, 140.0)]
    free, crossed = Placer(FRAME), Placer(FRAME)
    crossed.cross(line)
    first, second = (placer.place("word", 12.0, [point], (8.0,)) for placer in (free, crossed))
    assert first
    assert second
    on_line = Box(220, 139, 221, 141)
    assert covers(first.box, on_line)
    assert not covers(second.box, on_line)


def test_there_may_be_no_place() -> None:
    placer = Placer(Box(0, 0, 30, 30))
    assert placer.place("a long word", 12.0, [(15.0, 15.0)], (8.0,)) is None
    assert placer.place_upright("a long word", 12.0, 15.0) is None


def test_far_labels_are_marked_as_such() -> None:
    placer = Placer(FRAME)
    placer.take((200.0, 150.0), 15.0)
    placed = placer.place("word", 12.0, [(200.0, 150.0)], (8.0, 30.0))
    assert placed
    assert placed.is_far
    assert placed.anchor == (200.0, 150.0)


@pytest.mark.parametrize(
    ("other", "covered"), [((1, 1, 2, 2), True), ((2, 0, 3, 1), False), ((-1, -1, 5, 5), True), ((0, 2, 2, 4), False)]
)
def test_boxes_that_touch_do_not_overlap(other: tuple[float, float, float, float], covered: bool) -> None:
    assert covers(Box(0, 0, 2, 2), Box(*other)) is covered

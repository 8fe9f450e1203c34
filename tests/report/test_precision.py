"""Certificates of the hits of a picture, of scenes whose figures are known."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.report import precision
from minirt.report.precision import summarised
from minirt.scene import Scene
from minirt.shapes import KINDS
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import AMBIENT, EYE, RED

SCENE = Scene((AMBIENT, EYE, Sphere((0, 0, 20), 8, RED), Plane((0, -9, 0), (0, 1, 0), RED)))


@pytest.fixture(autouse=True)
def few_rays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(precision, "RAYS", 2000)


def test_each_kind_has_a_row_for_rays_from_the_eye_and_from_what_it_sees() -> None:
    rows = list(precision.hit_certificates(SCENE, 64, 40, 1))
    assert [(row.kind, row.rays) for row in rows] == [
        ("sphere", "from the eye"),
        ("plane", "from the eye"),
        ("sphere", "from what it sees"),
        ("plane", "from what it sees"),
    ]
    for row in rows:
        assert 0 <= row.backward_median <= row.backward_largest <= 4
        assert 1 <= row.condition_median <= row.condition_99 <= row.condition_largest
        assert row.normal_largest < 1e-13
        shares = row[5:11]
        assert sum(shares) == pytest.approx(1)
        assert shares[0] >= 0.5 or row.backward_median > 0.25


def test_a_summary_is_that_of_the_numbers() -> None:
    backward = np.array([0.0, 0.1, 0.3, 0.6, 1.5, 3.0, 5.0, 0.2, 0.2, 0.2])
    row = summarised(KINDS[0], "", backward, np.arange(1.0, 11.0), np.full(10, 1e-9))
    assert row[2:] == (10, 0.25, 5.0, 0.5, 0.1, 0.1, 0.1, 0.1, 0.1, 5.5, 10.0, 10.0, 1e-9)


def test_a_scene_of_which_nothing_is_seen_has_no_rows() -> None:
    behind = Scene((AMBIENT, EYE, Sphere((0, 0, -20), 8, RED)))
    assert list(precision.hit_certificates(behind, 64, 40, 1)) == []

"""Scenes are reduced to one feature, and the precisions are compared on them."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.materials import Checker, Specular
from minirt.rendering import Renderer
from minirt.rendering.packing.features import features
from minirt.report import precision
from minirt.report.precision import NEEDS_DOUBLE, NO_KERNEL, reduced, single_error, single_errors, summarised
from minirt.scene import Background, ParallelLight, Scene, SpotLight
from minirt.shapes import KINDS
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import ALL, AMBIENT, EYE, ONE, RED, linear

WHITE = (255, 255, 255)
SPOT = SpotLight(position=(0, 9, -3), direction=(0, -1, 0), angle=40.0, brightness=0.5, colour=WHITE)
SUN = ParallelLight(direction=(0, -1, 0), brightness=0.5, colour=WHITE)
RICH = Scene((*ALL.elements, SPOT, SUN, Background((9, 20, 40))))
RICH = RICH.replace(RICH.shapes[1], specular=Specular(0.5, 30.0), mirror=0.3)
RICH = RICH.replace(RICH.shapes[0], checker=Checker(1.0, (0, 0, 0)), specular=Specular(0.2, 9.0))
OWN = {type(shape) for shape in ALL.shapes}


@pytest.mark.parametrize("feature", ["specular", "reflective", "checks", "spots", "background", None])
def test_other_features_are_taken_away(feature: str | None) -> None:
    expected = OWN | ({feature} if feature else set()) | ({"parallel"} if feature == "spots" else set())
    made = reduced(RICH, feature)
    assert features(made) == expected
    assert len(made.shapes) == len(RICH.shapes)
    assert len(made.lights) == len(RICH.lights) - (feature != "spots")  # a spot shines in all directions


def test_every_feature_has_a_row() -> None:
    rows = list(single_errors(RICH, 32, 20, 1))
    names = ["shapes alone", "highlights", "mirrors and glass", "checkerboards"]
    assert [row.feature for row in rows][:4] == names
    assert len(rows) == 6
    assert rows[2].remark == NEEDS_DOUBLE
    assert all(row.remark in ("", NO_KERNEL) or row.feature == names[2] for row in rows)


def test_the_error_is_the_difference_of_the_precisions() -> None:
    single = Renderer(1, "single")
    for renderer in (ONE, single):
        renderer.specialise(ALL)
    row = single_error(ALL, "all", 48, 32, ONE, single)
    difference = np.clip(linear(ALL, 48, 32), 0, 1) - np.clip(linear(ALL, 48, 32, 1, single), 0, 1)
    assert row.rmse == pytest.approx(float(np.sqrt((difference**2).mean())))
    assert row.largest == np.abs(difference).max()
    assert 0 < row.rmse < 1e-3


# Certificates of the hits of a picture, of scenes whose figures are known.


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

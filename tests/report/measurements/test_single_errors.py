"""Scenes are reduced to one feature, and the precisions are compared on them."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.materials import Checker, Specular
from minirt.rendering import Renderer
from minirt.rendering.packing.features import features
from minirt.report.measurements.single_errors import NEEDS_DOUBLE, NO_KERNEL, reduced, single_error, single_errors
from minirt.scene import Background, ParallelLight, Scene, SpotLight
from tests.kernel.pictures import ALL, ONE, linear

WHITE = (255, 255, 255)
SPOT = SpotLight(position=(0, 9, -3), direction=(0, -1, 0), angle=40.0, brightness=0.5, colour=WHITE)
SUN = ParallelLight(direction=(0, -1, 0), brightness=0.5, colour=WHITE)
RICH = Scene((*ALL.elements, SPOT, SUN, Background((9, 20, 40))))
RICH = RICH.replace(RICH.shapes[1], specular=Specular(0.5, 30.0), mirror=0.3)
RICH = RICH.replace(RICH.shapes[0], checker=Checker(1.0, (0, 0, 0)), specular=Specular(0.2, 9.0))
KINDS = {type(shape) for shape in ALL.shapes}


@pytest.mark.parametrize("feature", ["specular", "reflective", "checks", "spots", "background", None])
def test_other_features_are_taken_away(feature: str | None) -> None:
    expected = KINDS | ({feature} if feature else set()) | ({"parallel"} if feature == "spots" else set())
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

"""What is left out as unseen does nothing for the picture."""

from __future__ import annotations

from math import isnan, nan

import numpy as np
import pytest

from minirt.materials import Specular
from minirt.rendering.packing.features import features
from minirt.report.measurements.ablation import Ablation
from minirt.report.measurements.run_times import Budget
from minirt.report.measurements.unseen import without_unseen
from minirt.scene import Scene
from minirt.shapes.plane import Plane
from minirt.shapes.torus import Torus
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, SHAPES, interpreted

GREY, SIZE = (128, 128, 128), (32, 20)
BEHIND = Plane((0, 0, -60), (0, 0, 1), GREY, mirror=0.5, specular=Specular(0.5, 30.0))  # the eye and the light
HIDDEN = Scene((AMBIENT, EYE, LAMP, *SHAPES[1:4] * 3, BEHIND))


def test_materials_and_kinds_that_no_pixel_shows() -> None:
    _, right = interpreted(HIDDEN, *SIZE)
    found = {variant.name: variant.scene for variant in without_unseen(HIDDEN, *SIZE)}
    assert list(found) == ["highlights", "mirrors and glass", "planes"]
    for name, gone in (("highlights", "specular"), ("mirrors and glass", "reflective"), ("planes", Plane)):
        assert features(HIDDEN) - features(found[name]) >= {gone}
    for scene in found.values():
        assert np.array_equal(interpreted(scene, *SIZE)[1], right)


def test_what_is_seen_or_casts_a_shadow_stays() -> None:
    assert list(without_unseen(ALL, *SIZE)) == []
    above = Torus((-3, 5, -4), (0, 1, 0), 1.0, 0.3, GREY)  # out of sight, between the light and the spheres
    assert [*without_unseen(Scene((*HIDDEN.elements[:-1], above)), *SIZE)] == []


def test_where_a_mirror_is_seen_all_stays() -> None:
    assert list(without_unseen(HIDDEN.replace(HIDDEN.shapes[1], mirror=0.2), *SIZE)) == []


@pytest.mark.parametrize(
    ("change", "ratios", "seconds"),
    [
        ("added", [1.25] * 5, 4.0 * 5),  # a fifth of each second is saved
        ("added", [0.9, 1.0, 1.1] * 3, nan),
        ("without", [0.8] * 5, 6.0 * 5),
        ("without", [1.25] * 5, nan),
    ],
)
def test_a_kernel_pays_once_it_has_saved_its_compile_time(change: str, ratios: list[float], seconds: float) -> None:
    measured = Ablation.__new__(Ablation)
    measured.compile_s, measured.budget = 4.0, Budget(0.0, 1.0, 1)
    found = measured.pays_after(change, ratios, 6.0)
    assert isnan(found) if isnan(seconds) else found == pytest.approx(seconds)

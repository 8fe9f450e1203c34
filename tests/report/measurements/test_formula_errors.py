"""Known errors of formulas are measured right, and the real formulas have small errors."""

from __future__ import annotations

from decimal import Decimal
from math import inf, isnan, nan
from typing import Any

import numpy as np
import pytest
from numba.core.registry import cpu_target

from minirt.helpers import system
from minirt.helpers.system import Run
from minirt.report.measurements import exact_hits, formula_errors, textbook
from minirt.report.measurements.eye_rays import rays_from_the_eye
from minirt.report.measurements.formula_errors import Answers, Row, compare, measure_formulas, time_ratio
from minirt.report.measurements.random_rays import Rays
from minirt.report.measurements.regimes import REGIMES, regimes_of
from minirt.shapes import KINDS, Kind, Shape, sphere
from minirt.shapes.box import Box
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from tests.kernel.pictures import ALL
from tests.simulated_clock import FORMULA_SECONDS, PROCESSOR_SHARE, in_turn

KIND = {kind.element: kind for kind in KINDS}
BALL = KIND[Sphere]
EVERY = pytest.mark.parametrize(
    "kind", [KIND[element] for element in exact_hits.SOLIDS], ids=lambda kind: kind.element.title
)


@pytest.fixture(autouse=True)
def machine(monkeypatch: pytest.MonkeyPatch) -> None:
    """Simulate a machine whose runs take known times."""
    monkeypatch.setattr(formula_errors, "in_turn", in_turn)


def rays_of(kind: Kind, name: str, shapes: int = 6) -> Rays:
    regime = next(each for each in regimes_of(kind) if each.name == name)
    return regime.pose(kind, np.random.default_rng(11), shapes, 32)


def rows_of(kind: Kind, name: str, shapes: int = 6) -> dict[str, Row]:
    return {row.formula: row for row in measure_formulas(kind, name, rays_of(kind, name, shapes))}


def answers(*t: float, thicker: Any = (), thinner: Any = ()) -> Answers:
    return Answers(*([Decimal(each) for each in some or t] for some in (t, thicker, thinner)))


def test_errors_by_hand() -> None:
    right = answers(2, 4, inf, 8)
    assert compare(np.array([2.0, 4.0, inf, 8.0]), right) == (3, 0, 0, 0, 0)
    hits, largest, rms, misses, false = compare(np.array([2.5, 4.0, 3.0, inf]), right)
    assert (hits, largest, misses, false) == (2, 0.25, 1, 1)
    assert rms == pytest.approx(0.25 / 2**0.5)


def test_errors_far_below_the_roundoff_of_the_answer_are_found() -> None:
    exactly = Decimal(1) / 3
    largest = compare(np.array([1 / 3]), Answers([exactly], [exactly], [exactly]))[1]
    assert largest == pytest.approx(float(abs(Decimal(1 / 3) * 3 - 1)), rel=1e-12)
    assert 0 < largest < 2.0**-53


def test_where_rounding_decides_both_verdicts_are_right() -> None:
    edge = answers(2, thicker=(2,), thinner=(inf,))
    for t in (2.0, inf):
        hits, largest, _, misses, false = compare(np.array([t]), edge)
        assert (hits, misses, false) == (0, 0, 0)
        assert isnan(largest)


def test_at_an_edge_either_place_that_rounding_chooses_between_is_right() -> None:
    edge = answers(3, thicker=(2,), thinner=(3,))
    assert [compare(np.array([t]), edge)[1] for t in (2.0, 3.0, 2.5)] == [0, 0, pytest.approx(0.5 / 3)]
    beside = answers(3, thicker=(3 - 1e-6,), thinner=(3,))
    assert compare(np.array([3 - 1e-6]), beside)[1] == pytest.approx(1e-6 / 3)


def test_nan_is_a_miss() -> None:
    assert compare(np.array([nan]), answers(2))[3] == 1


@EVERY
def test_the_own_formula_is_exact_and_float32_is_not(kind: Kind) -> None:
    rows = rows_of(kind, "benign")
    own, single = rows["miniRT"], rows["miniRT, float32"]
    assert own.rays == 192
    assert own.hits > 50
    assert own.max_error < 1e-12
    assert 1e-8 < single.max_error < 1e-2
    assert own.false_misses == own.false_hits == 0
    assert 0 < own.rms_error < own.max_error


@EVERY
@pytest.mark.parametrize("name", ["offset", "far"])
def test_float32_is_relative_to_the_eye(kind: Kind, name: str) -> None:
    single = rows_of(kind, name)["miniRT, float32"]
    assert single.hits > 50
    assert single.rms_error < 1e-4


def test_times_are_those_of_a_ray_in_the_best_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(formula_errors, "is_disturbed", lambda run, threads: run.wall < 1.5 * FORMULA_SECONDS)
    rows = rows_of(BALL, "benign")
    rays = formula_errors.TIMED
    assert list(rows) == ["miniRT", "textbook", "miniRT, float32"]
    for times, row in enumerate(rows.values(), 1):
        assert rays % row.rays, "of the last run a part is more than is asked for"
        assert row.ns_ray == pytest.approx(times * FORMULA_SECONDS * 1e9 / (-(-rays // row.rays) * row.rays))
        assert row.cpu_ns_ray == pytest.approx(PROCESSOR_SHARE * row.ns_ray)
        assert row.valid == (times > 1)
        assert row.times_textbook == pytest.approx(times / 2)
    assert isnan(rows_of(KIND[Box], "benign")["miniRT"].times_textbook)


def test_a_turn_in_which_the_machine_was_slow_counts_no_more_than_another() -> None:
    some, others = [Run(9, 2), Run(9, 30), Run(9, 4)], [Run(9, 1), Run(9, 10), Run(9, 4)]
    assert time_ratio(some, others) == 2
    assert isnan(time_ratio(some, []))


def test_runs_of_the_machine_take_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(formula_errors, "in_turn", system.in_turn)
    monkeypatch.setattr(formula_errors, "RUNS", 1)
    assert all(0 < row.ns_ray < inf and 0 < row.cpu_ns_ray < inf for row in rows_of(BALL, "benign").values())


def test_textbooks_lose_what_is_tiny_and_far() -> None:
    """float32 loses all such shapes with fused multiply-add, and most of them without."""
    rows = rows_of(BALL, "tiny and far", 12)
    own, naive, single = (rows[name] for name in ("miniRT", "textbook", "miniRT, float32"))
    assert own.max_error < 1e-15
    assert own.false_misses == own.false_hits == 0
    assert naive.false_misses > 10
    assert naive.false_hits > 5
    assert single.false_misses > 2 * single.hits
    assert single.false_misses > 10
    if "+fma" in cpu_target.target_context.codegen().magic_tuple()[2].split(","):
        assert single.hits == 0


@pytest.mark.parametrize("element", [Square, Disc], ids=lambda element: element.title)
def test_at_a_flat_slope_the_place_in_a_sheet_is_known_to_roundings_by_the_slope(element: type[Shape]) -> None:
    own = rows_of(KIND[element], "grazing")["miniRT"]
    assert own.hits > 50
    assert own.false_misses == own.false_hits == 0


def test_textbooks_crack_at_rims_and_take_grazing_for_parallel() -> None:
    rim, grazing = rows_of(KIND[Cylinder], "rim"), rows_of(KIND[Plane], "grazing")
    assert rim["miniRT"].max_error < 1e-12 < rim["textbook"].max_error
    assert grazing["miniRT"].false_misses == 0
    assert grazing["textbook"].hits == 0


def test_a_worse_formula_has_a_larger_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(formula_errors, "formulas", lambda kind: [("planted", textbook.meets_sphere, np.float64)])
    (planted,) = measure_formulas(BALL, "just above", rays_of(BALL, "just above"))
    assert planted.max_error > 1e-6


def test_a_formula_and_its_double_are_the_same_rays() -> None:
    shoot, found = formula_errors.prepare(sphere.intersect, rays_of(BALL, "benign"), BALL, np.float64)
    shoot(1)
    once = found.copy()
    shoot(3)
    assert np.array_equal(once, found)
    assert np.isfinite(found).any()


def test_a_disturbed_measurement_is_not_valid(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(formula_errors, "is_disturbed", lambda run, threads: True)
    assert not any(row.valid for row in rows_of(KIND[Plane], "benign").values())


def test_kinds_have_the_regimes_that_their_fields_allow() -> None:
    names = {kind.element: {regime.name for regime in regimes_of(kind)} for kind in KINDS}
    assert {"benign", "far", "offset"} <= names[Plane]
    assert "grazing" in names[Plane]
    assert not {"inside", "rim", "long tube"} & names[Plane]
    assert {"inside", "tangent", "just above"} <= names[Sphere]
    assert "rim" not in names[Sphere]
    assert names[Cylinder] == {regime.name for regime in REGIMES} - {"grazing"}


@pytest.mark.parametrize(
    ("name", "low", "high"), [("benign", 0.5, 40), ("far", 50, 2e6), ("tiny and far", 0.5e5, 2e6), ("offset", 0.5, 40)]
)
def test_rays_start_as_far_away_as_the_table_says(name: str, low: float, high: float) -> None:
    shapes, origins, directions = rays_of(BALL, name, 20)
    away = np.linalg.norm(origins - np.array([ball.centre for ball in shapes])[:, None], axis=-1)
    assert low < away.min() < away.max() < high
    assert np.abs(np.linalg.norm(directions, axis=-1) - 1).max() < 1e-15
    assert (np.linalg.norm([ball.centre for ball in shapes], axis=-1).mean() > 1e7) == (name == "offset")


def test_tangents_pass_close_to_the_surface() -> None:
    shapes, origins, directions = rays_of(BALL, "tangent")
    f = origins - np.array([ball.centre for ball in shapes])[:, None]
    closest = np.linalg.norm(f - (f * directions).sum(-1, keepdims=True) * directions, axis=-1)
    off = np.abs(closest - np.array([ball.diameter / 2 for ball in shapes])[:, None])
    assert off.max() < 1.1e-4
    assert np.median(off) < 1e-8


def test_rays_of_a_scene_start_at_its_eye_and_hit_its_shapes() -> None:
    for kind in KINDS:
        if not any(type(shape) is kind.element for shape in ALL.shapes):
            continue
        rays = rays_from_the_eye(kind, ALL, np.random.default_rng(1), 8, 32)
        assert set(rays.shapes) == {shape for shape in ALL.shapes if type(shape) is kind.element}
        assert (rays.origins == ALL.camera.position).all()
        assert next(measure_formulas(kind, "this scene", rays)).hits > 20
    many = rays_from_the_eye(BALL, ALL, np.random.default_rng(1), 1, 32)
    assert len(many.shapes) == 1

"""The table of formula times, from invented figures."""

from __future__ import annotations

import pytest

from minirt.report.measurements import formula_errors, textbook
from minirt.report.measurements.formula_errors import Row
from minirt.report.measurements.random_rays import Rays
from minirt.shapes import Kind
from tests.bench import formulas


def row(kind: str, formula: str, ns_ray: float, ratio: float, valid: bool = True) -> Row:
    return Row(kind, "benign", formula, 192, 100, 0.0, 0.0, 0, 0, ns_ray, ns_ray, ratio, valid)


INVENTED = [
    row("sphere", "miniRT", 1.234, 1.51),
    row("sphere", "textbook", 0.824, 1),
    row("hyperboloid", "miniRT", 12.3, 0.98, valid=False),
    row("hyperboloid", "textbook", 12.5, 1),
]


def test_the_table() -> None:
    assert formulas.table(INVENTED).splitlines() == [
        "ns a ray         textbook        miniRT",
        "sphere        0.82   x1.0   1.23   x1.5",
        "hyperboloid  12.50   x1.0  12.30* x0.98",
    ]


def test_the_records() -> None:
    first, *_, last = formulas.records(INVENTED[:3])
    assert first == {
        "kind": "sphere", "formula": "miniRT", "ns a ray": 1.234, "times textbook": 1.51, "disturbed": False,
    }  # fmt: skip
    assert (last["kind"], last["disturbed"]) == ("hyperboloid", True)


def test_each_formula_of_a_textbook_is_measured_beside_the_exact_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def measured(kind: Kind, regime: str, rays: Rays) -> list[Row]:
        assert (regime, rays.origins.shape, {*map(type, rays.shapes)}) == ("benign", (6, 32, 3), {kind.element})
        return [row(kind.element.title, name, 2.0, 0.5) for name in ("miniRT", "textbook", "miniRT, float32")]

    monkeypatch.setattr(formula_errors, "measure_formulas", measured)
    rows = list(formulas.measured())
    assert [(each.kind, each.formula) for each in rows] == [
        (element.title, formula) for element in textbook.FORMULAS for formula in ("miniRT", "textbook")
    ]
    assert formulas.table(rows).count("2.00  x0.50") == len(textbook.FORMULAS)
    assert "nanoseconds on one thread" in formulas.MEANING

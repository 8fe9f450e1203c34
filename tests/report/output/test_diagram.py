"""The work-precision diagram shows the measured settings."""

from __future__ import annotations

from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import pytest

from minirt.report.measurements.findings import EIGHT_BITS
from minirt.report.measurements.picture_errors import Row
from minirt.report.output.diagram import draw, standalone
from minirt.report.output.panel import NARROW, WIDE, Size, diagram_of
from tests.report.made_up import REFERENCE_ERROR, ROWS, row

SVG = "{http://www.w3.org/2000/svg}"


def drawn(
    rows: list[Row], best: list[Row] | None = None, reference: float = REFERENCE_ERROR, size: Size = WIDE
) -> Element:
    return ElementTree.fromstring(draw(diagram_of("a scene", rows, reference, EIGHT_BITS, best or []), size))


def classed(parent: Element, name: str) -> list[Element]:
    return [each for each in parent.iter() if name in each.get("class", "").split()]


def texts(parent: Element) -> list[str]:
    return ["".join(each.itertext()) for each in parent.iter(f"{SVG}text")]


def ends(path: Element) -> list[tuple[float, float]]:
    """Return the points of a path."""
    return [(float(x), float(y)) for x, y in (pair.split(",") for pair in path.get("d", "")[1:].split("L"))]


def test_each_setting_has_a_line_with_its_name() -> None:
    picture = drawn(ROWS)
    lines = classed(picture, "line")
    assert [line.get("data-name") for line in lines] == ["uniform", "adaptive", "<slow> & sure", "POV-Ray"]
    assert len({line.get("class") for line in lines}) == 4
    names = [name for each in classed(picture, "name") for name in texts(each)]
    assert sorted(names) == sorted(["uniform", "adaptive", "<slow> & sure", "POV-Ray"])
    assert [len(classed(line, "point")) for line in lines] == [3, 2, 2, 3]


def test_less_error_is_left_and_more_time_is_up() -> None:
    (line,) = classed(drawn([row("uniform", samples) for samples in (1, 4, 16)]), "join")
    (x1, y1), (x2, y2), (x3, y3) = ends(line)
    assert x1 > x2 > x3
    assert y1 > y2 > y3  # rows count downwards
    assert x1 - x2 == pytest.approx(x2 - x3, abs=0.2)  # a factor of 4 twice


def test_bars_are_the_confidence_intervals() -> None:
    (point,) = classed(drawn([row("uniform", 1)]), "point")
    across, up = (ends(bar) for bar in classed(point, "interval"))
    assert across[0][1] == across[1][1]
    assert up[0][0] == up[1][0]
    assert across[0][0] < up[0][0] < across[1][0]
    unknown = row("uniform", 1)._replace(rmse_low=float("nan"), wall_high_ms=float("nan"))
    assert classed(classed(drawn([unknown]), "point")[0], "interval") == []


def test_disturbed_points_are_hollow_and_recommended_ones_have_a_ring() -> None:
    rows = [row("uniform", 1), row("uniform", 4, valid=False), row("uniform", 16)]
    points = classed(drawn(rows, [rows[2]]), "point")
    assert [bool(classed(point, "hollow")) for point in points] == [False, True, False]
    assert [bool(classed(point, "ring")) for point in points] == [False, False, True]
    told = ["".join(point[0].itertext()) for point in points]
    assert told[1] == "uniform 4: RMSE 0.01, 10 ms; other programs needed the processors"
    assert told[2].endswith("recommended")


def test_the_front_has_no_disturbed_points_and_no_other_programs() -> None:
    rows = [row("uniform", 1), row("uniform", 4), row("quick", 4, 0.5, valid=False), row("other", 16, 0.1, program="x")]
    (front, _) = classed(drawn(rows), "front")  # the second is that of the key
    assert len(ends(front)) == 2


def test_other_programs_have_dashed_lines() -> None:
    assert [line.get("data-name") for line in classed(drawn(ROWS), "other")] == ["POV-Ray"]


def test_floors_are_lines_with_their_names() -> None:
    eight_bits, reference = classed(drawn(ROWS, reference=0.005), "floor")
    assert texts(eight_bits) == ["rounding to 8 bits: 0.0011"]
    assert texts(reference) == ["error of the reference: 0.005"]
    (x, _), (to_x, _) = ends(eight_bits[0])
    assert x == to_x < ends(reference[0])[0][0]


def test_a_floor_far_below_takes_no_room() -> None:
    """It is told at the edge, and the axis stays as it is."""
    near, far = (drawn([row("uniform", 1), row("uniform", 16)], reference=error) for error in (0.0, 1e-6))
    (_, floor) = classed(far, "floor")
    assert texts(floor) == ["← error of the reference: 1e-06"]
    assert list(floor.iter(f"{SVG}path")) == []
    assert ends(classed(near, "join")[0]) == ends(classed(far, "join")[0])


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_twelve_lines_have_all_their_names(size: Size) -> None:
    """Also where they nearly coincide."""
    rows = [row(f"setting {name}", samples, 1 + 0.01 * name) for name in range(12) for samples in (1, 4, 16)]
    assert len(classed(drawn(rows, size=size), "name")) == 12


@pytest.mark.parametrize("rows", [[], [Row("failed", "1")], [row("uniform", 1)]])
def test_few_points_are_drawn_too(rows: list[Row]) -> None:
    picture = drawn(rows, reference=0.0)
    assert len(classed(picture, "point")) == len([each for each in rows if each.rmse > 0])
    assert len(texts(classed(picture, "axis")[0])) >= 3  # two labels and the title


def test_a_file_has_its_style_and_names_no_other() -> None:
    text = standalone(draw(diagram_of("a < b", ROWS, REFERENCE_ERROR, EIGHT_BITS, []), WIDE))
    picture = ElementTree.fromstring(text)
    assert "--line" in "".join(picture.find(f"{SVG}style").itertext())  # type: ignore[union-attr]
    assert "prefers-color-scheme: dark" in text
    assert text.count("http") == 1  # the name space
    assert "url(" not in text

"""The work-precision diagram shows the measured settings."""

from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from minirt.report.measurements.picture_errors import Row
from tests.bench.system import INSTALL

drawing = pytest.importorskip(
    "minirt.report.output.diagram", reason=f"needs matplotlib; {INSTALL}", exc_type=ImportError
)
RED, BLUE = drawing.COLOURS[:2]


def row(knob: str, samples: int, valid: bool = True) -> Row:
    return Row(knob, str(samples), samples=samples, rmse=0.1 / samples, wall_ms=3.0 * samples, valid=valid)


def drawn(*rows: Row, reference: float = 0.001) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(drawing.diagram(rows, reference, "a scene"))).convert("RGB"))


def area(picture: np.ndarray, colour: str) -> int:
    """Count the pixels of a colour."""
    return int((picture == list(bytes.fromhex(colour[1:]))).all(axis=-1).sum())


def uprights(picture: np.ndarray) -> int:
    """Count the vertical lines, dashed or not, from the bottom to the top."""
    dark = (picture.max(axis=-1) < 190).mean(axis=0) > 0.4
    return int((np.diff(dark.astype(int)) == 1).sum())


def test_each_knob_has_a_line_of_its_colour() -> None:
    picture = drawn(row("uniform", 1), row("uniform", 4), row("adaptive", 4), row("adaptive", 16))
    assert area(picture, RED) > 500
    assert area(picture, BLUE) > 500
    assert area(drawn(row("uniform", 1), row("uniform", 4)), BLUE) == 0


def test_less_error_is_left_and_more_time_is_up() -> None:
    picture = drawn(row("uniform", 1), row("uniform", 4), row("uniform", 16))
    line = (picture == list(bytes.fromhex(RED[1:]))).all(axis=-1)
    line[:, line.shape[1] * 3 // 4 :][: line.shape[0] // 3] = False  # the legend
    columns = [np.flatnonzero(line[:, x]).mean() for x in range(150, 800) if line[:, x].any()]
    assert columns[0] < columns[-1]  # rows count downwards


def test_points_that_are_not_valid_are_hollow() -> None:
    solid, hollow = (drawn(row("uniform", 1, valid), row("uniform", 4, valid)) for valid in (True, False))
    assert area(hollow, RED) < area(solid, RED) - 50


def test_the_error_of_the_reference_is_a_line_among_the_points() -> None:
    rows = row("uniform", 1), row("uniform", 4)
    without = drawn(*rows, reference=0.0)
    assert uprights(drawn(*rows, reference=0.05)) == uprights(without) + 1


def test_the_error_of_the_reference_takes_no_room_beside_the_points() -> None:
    """Far left of all points it is told in the legend, and the axis stays as it is."""
    rows = row("uniform", 1), row("uniform", 4)
    without, beside = drawn(*rows, reference=0.0), drawn(*rows, reference=1e-5)
    assert uprights(beside) == uprights(without)
    assert np.array_equal(beside[-60:], without[-60:])  # the labels of the axis of errors
    assert not np.array_equal(beside, without)


def test_failed_settings_are_not_drawn() -> None:
    picture = drawn(row("uniform", 1), row("uniform", 4), Row("failed", "1"))
    assert area(picture, RED) > 500
    assert drawn(Row("failed", "1")).shape == picture.shape

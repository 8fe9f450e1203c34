"""Fields accept, refuse and spell values, and key presses change them."""

from __future__ import annotations

import math
import random
import re
import sys
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from minirt.element import fields_of
from minirt.fields import Colour, Direction, Field, FieldError, Length, Point, Real, Whole, neat, spelled, unit
from minirt.fields.scalars import LONGEST, Factor, Flag, number, whole
from minirt.fields.triples import Lengths
from minirt.scene import Camera, Light
from minirt.shapes.sphere import Sphere

U = 2.0**-53
RATIO = Real(doc="a ratio", low=0.0, high=1.0, step=0.05)
SIZE = Length(doc="a size")
LENGTHS = Lengths(doc="lengths")
FLAG = Flag(doc="a flag")
FACTOR = Factor(doc="a factor", high=50.0)
PIXELS = Whole(doc="pixels", low=1, high=100)
POINT = Point(doc="a point")
DIRECTION = Direction(doc="a direction")
COLOUR = Colour(doc="a colour")


@pytest.mark.parametrize("read", [number, whole])
def test_a_number_of_too_many_characters_is_quoted_with_their_number(read: Callable[[str], float]) -> None:
    assert read("0" * LONGEST) == 0
    with pytest.raises(FieldError, match="got 'x"):
        read("x" * LONGEST)
    with pytest.raises(FieldError, match=f"got {LONGEST + 1} characters: '0"):
        read("0" * (LONGEST + 1))


@given(st.floats(allow_nan=False, allow_infinity=False))
@example(-0.0)
@example(5e-324)
@example(sys.float_info.max)
def test_a_spelled_number_reads_back_to_the_last_bit(value: float) -> None:
    assert number(spelled(value)) == value
    assert math.copysign(1, number(spelled(value))) == (math.copysign(1, value) if value else 1)


@given(st.text("0123456789+-.eE_ xnaif", max_size=8))
def test_every_number_is_read_as_float_reads_it(text: str) -> None:
    try:
        value = number(text)
    except FieldError:
        return
    assert value == float(text)
    assert "_" not in text + " "


@pytest.mark.parametrize("text", ["1.5", "1.", "1e2", "", "+", "\uff11", "1_0", " 1", "0x1", "9" * 301])
def test_a_text_that_is_no_whole_number_is_refused(text: str) -> None:
    with pytest.raises(FieldError, match="must be a whole number"):
        whole(text)


@given(st.tuples(*[st.floats(-1e15, 1e15)] * 3).filter(any))
@example((5e-324, 5e-324, 0.0))
@example((1e-200, -1e-200, 1e-200))
@example((1e200, 1e200, 1e200))
@example((1.0, 1e-300, 0.0))
def test_a_unit_vector_has_length_1_and_its_own_direction(vector: tuple[float, float, float]) -> None:
    x, y, z = unit(vector)
    assert abs(math.hypot(x, y, z) - 1) <= 4 * U
    largest = max(map(abs, vector))
    length = math.hypot(*(each / largest for each in vector))
    assert (x, y, z) == pytest.approx([each / largest / length for each in vector], abs=8 * U)


def test_no_component_of_a_unit_vector_is_beyond_1() -> None:
    beyond = 1 + 2 * U
    assert unit((0.0, -beyond, -U / 2)) == pytest.approx((0.0, -1.0, 0.0))
    for x, y, z in ((beyond, 0.0, 0.0), (1e-9, 0.0, -beyond), (0.0, beyond, 1e-17)):
        assert max(map(abs, unit((x, y, z)))) <= 1


def test_normalising_again_changes_no_bit() -> None:
    rng = random.Random(1)
    for _ in range(200_000):
        once = unit((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)))
        assert unit(once) == once


@pytest.mark.parametrize(
    ("field", "value"),
    [
        *((RATIO, value) for value in (-0.1, 1.1, math.nan, math.inf)),
        *((SIZE, value) for value in (0, -1, math.nan, math.inf, 1.1e15)),
        *((LENGTHS, value) for value in ((1, 0, 1), (1, 1, -1), (math.nan, 1, 1), (1, 1, 1.1e15), (1, 1))),
        *((PIXELS, value) for value in (0, 101, 1.5, math.nan, math.inf)),
        *((POINT, value) for value in ((0, 0), (0, 0, 0, 0), 5, (0, math.nan, 0), (0, 0, 1.1e15), ("a", 0, 0))),
        *((DIRECTION, value) for value in ((0, 0, 0), (0, 1.1, 0), (math.nan, 0, 1), (1, 0))),
        *((COLOUR, value) for value in ((256, 0, 0), (0, -1, 0), (0, 0, 0.5), (0, math.nan, 0), (0, 0), None)),
    ],
)
def test_a_field_refuses_wrong_values(field: Field, value: Any) -> None:
    with pytest.raises(FieldError):
        field.check(value)


def test_the_error_names_the_length_that_is_not_positive() -> None:
    with pytest.raises(FieldError, match=r"^y must be > 0, got -2$") as caught:
        LENGTHS.check((1.0, -2.0, 3.0))
    assert caught.value.part == 1


def test_the_error_names_the_element_and_the_field() -> None:
    with pytest.raises(ValueError, match=r"^sphere diameter must be > 0, got -3$"):
        Sphere((0, 0, 0), -3, (0, 0, 0))
    with pytest.raises(ValueError, match=r"^camera direction y must be in \[-1, 1\], got 2$"):
        Camera((0, 0, 0), (0, 2, 0), 70)


def test_an_element_normalises_its_values() -> None:
    camera = Camera((1, 2, 3), (0, 0, -0.5), 70)
    assert camera.direction == (0.0, 0.0, -1.0)
    assert all(type(each) is float for each in (*camera.position, *camera.direction, camera.fov))
    assert camera.replace(fov=60).direction == camera.direction


@pytest.mark.parametrize(
    ("field", "value", "steps", "after"),
    [
        (RATIO, 0.5, 2, 0.6),
        (RATIO, 0.5, 1000, 1.0),
        (RATIO, 0.5, -1000, 0.0),
        (SIZE, 2.0, 1, 2.1),
        (SIZE, 2.1, -1, 2.0),
        (SIZE, 2.0, -1e9, 1e-9),
        (SIZE, 1e-12, -1, 1e-12),
        (SIZE, 2.0, 1e9, 1e15),
        (FACTOR, 2.0, 1, 2.2),
        (FACTOR, 2.2, -1, 2.0),
        (FACTOR, 2.0, -1e9, 1.0),
        (FACTOR, 2.0, 1e9, 50.0),
        (COLOUR, (0, 100, 255), 1, (8, 108, 255)),
        (COLOUR, (0, 100, 255), -1, (0, 92, 247)),
        (FLAG, False, 1, True),
        (FLAG, True, -1, False),
        (POINT, (1.0, 2.0, 3.0), 5, (1.0, 2.0, 3.0)),
    ],
)
def test_a_key_press_steps_a_value_within_its_range(field: Field, value: Any, steps: float, after: Any) -> None:
    assert field.nudge(value, steps) == pytest.approx(after)
    assert field.check(field.nudge(value, steps)) == field.nudge(value, steps)


def test_the_fields_of_an_element_have_names_and_defaults() -> None:
    given, keyed = ["position", "direction", "fov"], ["roll", "tone", "exposure", "lens", "focus"]
    assert [field.name for field in fields_of(Camera)] == given + keyed
    assert [field.keyed for field in fields_of(Camera)] == [False] * len(given) + [True] * len(keyed)
    assert [field.default for field in fields_of(Light)] == [None, None, (255, 255, 255), None, None]


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), st.lists(st.integers(-9, 0), min_size=3, max_size=3))
def test_a_neat_direction_is_written_with_nine_digits_and_read_with_the_same_bits(
    parts: list[float], powers: list[int]
) -> None:
    vector = tuple(part * 10.0**power for part, power in zip(parts, powers, strict=True))
    assume(max(map(abs, vector)) > 1e-9)
    direction = unit(vector)  # type: ignore[arg-type]
    found = neat(direction)
    assert math.dist(found, direction) <= 2e-9
    text = DIRECTION.format(found)
    assert unit(tuple(map(float, text.split(",")))) == found  # type: ignore[arg-type]
    for part in text.split(","):
        assert re.fullmatch(r"-?(0|1|0\.[0-9]+)", part), text
        assert len(part.lstrip("-0.")) <= 9
    assert neat(found) == found or math.dist(neat(found), found) <= 2e-9


def test_a_direction_with_all_digits_is_written_with_them() -> None:
    for direction in (unit((math.pi / 10, math.e / 10, 0.7)), (1.0, 1e-300, 0.0), (6.12e-17, 1.0, 0.0)):
        assert DIRECTION.format(direction) == ",".join(map(spelled, direction))

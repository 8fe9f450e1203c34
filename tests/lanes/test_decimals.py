"""Decimal numbers are rounded as by `float`, or said not to be."""

from __future__ import annotations

import random
from struct import pack

import pytest

from minirt.lanes.decimals import read_decimal
from minirt.meshes import obj_lines

CHANCE = random.Random(5)
HARD = ["9007199254740993", "-.5", "5.", "0e500", "-0", "4.9e-324", "1e22", "1e-22", "0.30000000000000004", "1" * 19]
HARD += ["90071992547409930e-2", "4503599627370495.75", "9007199254740991.75", "+0." + "0" * 30 + "1", "1e-400"]
RANDOM = [repr(CHANCE.gauss(0, 10.0 ** CHANCE.randint(-4, 9))) for _ in range(500)]
RANDOM += [f"{CHANCE.gauss(0, 10):.{CHANCE.randint(0, 20)}f}" for _ in range(1000)]


def test_compiled_numbers_are_rounded_as_by_python(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj_lines, "LARGE", 0)
    numbers = [each for each in HARD + RANDOM if float(each) <= 1e15]
    read = obj_lines.read("".join(f"v 0 0 {each}\n" for each in numbers).encode()).points[:, 2]
    assert [pack("d", each) for each in read] == [pack("d", float(each)) for each in numbers]


def test_most_numbers_need_no_second_reader() -> None:
    inexact = 0
    for number in HARD + RANDOM:
        value, end, is_exact = read_decimal([*f"{number} ".encode()], 0)
        assert end == len(number)
        assert not is_exact or pack("d", value) == pack("d", float(number))
        inexact += not is_exact
    assert inexact < 0.15 * len(RANDOM)

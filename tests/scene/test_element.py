"""Elements that are made many at once equal those made one by one, and take no more memory."""

from __future__ import annotations

import pickle
import sys
import tracemalloc
from dataclasses import FrozenInstanceError
from typing import Any

import pytest

from minirt.element import Element
from minirt.fields import Real, declare
from minirt.records import record
from minirt.shapes.sphere import Sphere

COLUMNS = {"centre": [(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)], "diameter": [1.0, 2.0], "colour": [(1, 2, 3)] * 2}


def test_elements_made_at_once_are_equal_frozen_and_pickled_like_single_ones() -> None:
    batch = Sphere.checked(2, {**COLUMNS, "source": ["a", "b"]})
    built = [Sphere(*row) for row in zip(*COLUMNS.values(), strict=True)]
    assert batch == built
    assert list(map(hash, batch)) == list(map(hash, built))
    assert [each.source for each in batch] == ["a", "b"]
    again = pickle.loads(pickle.dumps(batch))
    assert [vars(each) for each in again] == [vars(each) for each in batch]
    assert batch[1].replace(diameter=9).diameter == 9
    with pytest.raises(ValueError, match="diameter"):
        batch[1].replace(diameter=-1)
    with pytest.raises(FrozenInstanceError):
        batch[0].diameter = 5.0  # type: ignore[misc]


@pytest.mark.skipif(sys.implementation.name != "cpython", reason="about the attributes of CPython objects")
def test_elements_made_at_once_take_no_more_memory() -> None:
    @record()
    class Cloud(Element):  # a new class, of which CPython has seen no instance
        code, title, plural = "cl", "cloud", "clouds"
        width: float = declare(Real, "width")
        height: float = declare(Real, "height")
        depth: float = declare(Real, "depth")

    @record()
    class Fog(Cloud):
        code, title, plural = "fo", "fog", "fogs"

    def bytes_each(make: Any) -> int:
        tracemalloc.start()
        try:
            kept = make()
            return tracemalloc.get_traced_memory()[0] // len(kept)
        finally:
            tracemalloc.stop()

    values = [float(i) for i in range(1000)]
    columns: dict[str, Any] = dict.fromkeys(("width", "height", "depth"), values) | {"source": [""] * 1000}
    one_by_one = bytes_each(lambda: [Cloud(value, value, value) for value in values])
    assert bytes_each(lambda: Fog.checked(1000, columns)) <= 1.1 * one_by_one

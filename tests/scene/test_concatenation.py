"""A concatenation of tuples behaves like one tuple of all of their entries."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.scene.concatenation import Concatenation

PARTS = st.lists(st.lists(st.integers(0, 9), max_size=4).map(tuple), max_size=5)
INDEX = st.integers(-25, 25)


@given(PARTS, INDEX, st.slices(20))
def test_reading_gives_what_a_tuple_gives(parts: list[tuple[int, ...]], index: int, cut: slice) -> None:
    whole = tuple(each for part in parts for each in part)
    sequence = Concatenation(parts)
    assert (len(sequence), tuple(sequence), repr(sequence), hash(sequence)) == (
        len(whole),
        whole,
        repr(whole),
        hash(whole),
    )
    assert sequence[cut] == whole[cut]
    assert list(reversed(sequence)) == list(reversed(whole))
    assert [each in sequence for each in range(10)] == [each in whole for each in range(10)]
    if -len(whole) <= index < len(whole):
        assert sequence[index] == whole[index]
        part, at = sequence.locate(index)
        assert (sum(map(len, parts[:part])) + at, parts[part][at]) == (index % len(whole), whole[index])
    else:
        with pytest.raises(IndexError):
            sequence[index]


@given(PARTS, PARTS)
def test_sequences_of_equal_entries_are_equal(parts: list[tuple[int, ...]], others: list[tuple[int, ...]]) -> None:
    whole, other = (tuple(each for part in each_parts for each in part) for each_parts in (parts, others))
    assert (Concatenation(parts) == Concatenation(others)) == (whole == other)
    assert (Concatenation(parts) == other) == (other == Concatenation(parts)) == (whole == other)
    assert Concatenation(parts) == Concatenation([whole])
    assert Concatenation(parts) != list(whole)

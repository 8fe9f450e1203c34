"""Concatenation of tuples that is not copied, so that two long sequences can share most of their parts."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, chain
from typing import TypeVar, overload

T_co = TypeVar("T_co", covariant=True)


class Concatenation(Sequence[T_co]):
    """Immutable sequence of the entries of several tuples; equal to a tuple or concatenation of equal entries.

    A slice is a tuple.
    """

    def __init__(self, parts: Iterable[tuple[T_co, ...]]) -> None:
        self.parts = tuple(parts)
        self.ends = tuple(accumulate(map(len, self.parts)))

    def locate(self, index: int) -> tuple[int, int]:
        """Return the number of the part with entry `index`, and the index in that part; IndexError beyond the end."""
        position = index + len(self) if index < 0 else index
        if not 0 <= position < len(self):
            raise IndexError(f"no index {index} in a sequence of {len(self)}")
        part = bisect_right(self.ends, position)
        return part, position - (self.ends[part - 1] if part else 0)

    def __len__(self) -> int:
        return self.ends[-1] if self.ends else 0

    def __iter__(self) -> Iterator[T_co]:
        return chain.from_iterable(self.parts)

    @overload
    def __getitem__(self, index: int) -> T_co: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[T_co, ...]: ...

    def __getitem__(self, index: int | slice) -> T_co | tuple[T_co, ...]:
        if isinstance(index, slice):
            return tuple(self)[index]
        part, offset = self.locate(index)
        return self.parts[part][offset]

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Concatenation) and self.parts == other.parts:
            return True
        return isinstance(other, (Concatenation, tuple)) and len(self) == len(other) and tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return repr(tuple(self))

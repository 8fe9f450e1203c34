"""Handle: base class of displays, windows and images, which are numbers in the official wrapper."""

from __future__ import annotations

import itertools
from typing import Self

_numbers = itertools.count(1 << 40, 64)  # as great as addresses: no colour and no position equals a handle


class Handle(int):
    """An object that is a number of its own, too: programs print handles, compare them and use them as keys."""

    def __new__(cls, *_arguments: object, **_named: object) -> Self:
        return super().__new__(cls, next(_numbers))

"""The parts of a fuzzer: one function makes an input, another one checks what the program says to it."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import NamedTuple


class Fuzzer(NamedTuple):
    """Makes inputs at random, and checks each.

    `check` returns the verdict on an input, such as "accepted". AssertionError for a wrong verdict; any other exception
    is a crash.
    """

    make: Callable[[random.Random], bytes]
    check: Callable[[bytes], str]
    short: int  # inputs of the short run in `make test`


def seeded(name: str, number: int) -> random.Random:
    """Return the random numbers of one input: the same for the same fuzzer and number, on every machine."""
    return random.Random(f"{name} {number}")

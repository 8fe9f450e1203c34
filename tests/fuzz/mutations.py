"""A fuzzer: one function makes an input, another one checks what the program says to it; and mutations of bytes."""

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


ODD = (
    *(b"\0", b"\r", b"\n", b"\v", b"\f", b"\x80", b"\xff", b"\xef\xbb\xbf", b"\xff\xfe", b"\xed\xa0\x80"),
    *("\x85", "\xa0", "\u2028", "\u2212", "\u0663", "\uff11", "\u00e9"),
    *("nan", "inf", "-inf", "1e400", "-1e999", "1e-400", "0x1F", "1_0", "--1", "+", "-", ".", "1..2", "1e", "٣"),
    *("1e15", "-1e15", "1.0000000000000002e15", "5e-324", "-0", "007", "9" * 299, "9" * 301, "4294967296"),
    *(",", ",,", ", ", " ,", "#", "//", ":", "/", "\\\n", "\t", " ", "\n\n"),
)
INSERTED = [each if isinstance(each, bytes) else each.encode() for each in ODD]
LONGEST = 24  # bytes that a mutation takes out or doubles


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Return the data with one to four mutations, which know no format."""
    for _ in range(chance.choice((1, 1, 1, 2, 3, 4))):
        begin, at, odd = chance.randint(0, len(data)), chance.randint(0, len(data)), chance.choice(INSERTED)
        end = min(len(data), begin + chance.randint(1, LONGEST))
        data = chance.choice(
            (
                flip(data, chance),
                data[:at],  # cut off
                data[:begin] + data[end:],  # a short part deleted,
                data[:end] + data[begin:end] + data[end:],  # doubled,
                data[:at] + data[begin:end] + data[at:],  # copied to another place;
                *[data[:at] + odd + data[at:]] * 2,  # something odd inserted,
                *[data[:begin] + odd + data[end:]] * 2,  # put in the place of a part
            )
        )
    return data


def flip(data: bytes, chance: random.Random) -> bytes:
    """Flip one bit."""
    if not data:
        return data
    at = chance.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]

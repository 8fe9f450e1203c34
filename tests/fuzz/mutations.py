"""Mutations of bytes that know no format: bits flipped, parts deleted, doubled, exchanged and inserted."""

from __future__ import annotations

import random

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
    """Return the data with one to four mutations."""
    for _ in range(chance.choice((1, 1, 1, 2, 3, 4))):
        data = chance.choice(MUTATIONS)(data, chance)
    return data


def place(data: bytes, chance: random.Random) -> tuple[int, int]:
    """Return the begin and the end of a short part of the data."""
    begin = chance.randint(0, len(data))
    return begin, min(len(data), begin + chance.randint(1, LONGEST))


def flip(data: bytes, chance: random.Random) -> bytes:
    """Flip one bit."""
    if not data:
        return data
    at = chance.randrange(len(data))
    return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]


def delete(data: bytes, chance: random.Random) -> bytes:
    """Delete a short part."""
    begin, end = place(data, chance)
    return data[:begin] + data[end:]


def double(data: bytes, chance: random.Random) -> bytes:
    """Write a short part twice."""
    begin, end = place(data, chance)
    return data[:end] + data[begin:end] + data[end:]


def insert(data: bytes, chance: random.Random) -> bytes:
    """Insert something odd."""
    at = chance.randint(0, len(data))
    return data[:at] + chance.choice(INSERTED) + data[at:]


def replace(data: bytes, chance: random.Random) -> bytes:
    """Replace a short part by something odd."""
    begin, end = place(data, chance)
    return data[:begin] + chance.choice(INSERTED) + data[end:]


def cut(data: bytes, chance: random.Random) -> bytes:
    """Cut the data off."""
    return data[: chance.randint(0, len(data))]


def move(data: bytes, chance: random.Random) -> bytes:
    """Copy a short part to another place."""
    begin, end = place(data, chance)
    at = chance.randint(0, len(data))
    return data[:at] + data[begin:end] + data[at:]


MUTATIONS = (flip, delete, double, insert, insert, replace, replace, cut, move)

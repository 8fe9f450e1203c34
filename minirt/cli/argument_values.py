"""Parsers of sizes and numbers on the command line; ArgumentTypeError says what is wrong with a text."""

from __future__ import annotations

import re
from argparse import ArgumentTypeError
from math import inf
from typing import NamedTuple

MAX_SIDE = 16384  # pixels
MOST = 999_999_999  # pixels of a side that --cluster takes, if the format holds them
LEAST_MEMORY, MOST_MEMORY = 2**20, 2**50  # bytes
MAX_EXPOSURE = 20.0  # EV, up and down
TEXT_SCALES = 0.5, 4.0  # least and largest, as with keys in the window


def file_name(text: str) -> str:
    """Check that the name of a file or folder is not empty."""
    if not text:
        raise ArgumentTypeError("must be the name of a file, got ''")
    return text


def size(text: str) -> tuple[int, int]:
    """Parse a size in pixels, such as 640x480."""
    width, _, height = text.partition("x")
    if not (width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise ArgumentTypeError(f"must be WIDTHxHEIGHT, like 640x480, got '{text}'")
    return whole_number(width, 1, MOST), whole_number(height, 1, MOST)


def cluster(text: str) -> str:
    """Parse the place of workers: local, or the address of a scheduler."""
    if text != "local" and not re.fullmatch(r"[a-z]+://[!-~]+", text):
        raise ArgumentTypeError(f"must be local, or the address of a scheduler like tcp://host:8786, got '{text[:40]}'")
    return text


class Region(NamedTuple):
    """A rectangle of a picture, in pixels from its upper left corner; written as on the command line."""

    x: int
    y: int
    width: int
    height: int

    def __str__(self) -> str:
        return ",".join(map(str, self))


def region(text: str) -> Region:
    """Parse a rectangle of a picture, such as 320,0,640,480."""
    numbers = text.split(",")
    if len(numbers) != 4 or not all(each.isascii() and each.isdigit() for each in numbers):
        raise ArgumentTypeError(f"must be X,Y,WIDTH,HEIGHT, like 320,0,640,480, got '{text[:40]}'")
    place = (whole_number(each, 0, MAX_SIDE) for each in numbers[:2])
    return Region(*place, *(whole_number(each, 1, MAX_SIDE) for each in numbers[2:]))


def whole_number(text: str, low: int, high: int) -> int:
    """Parse a whole number in [low, high]."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high):
        raise ArgumentTypeError(f"must be a whole number from {low} to {high}, got '{text[:40]}'")
    return int(text)


def span(text: str) -> range:
    """Parse numbers of frames: 10-20, or 7 alone."""
    first, dash, last = text.partition("-")
    try:
        start = whole_number(first, 1, 3600)
        return range(start, whole_number(last, start, 3600) + 1 if dash else start + 1)
    except ArgumentTypeError:
        raise ArgumentTypeError(f"must be FIRST-LAST, like 10-20, got '{text[:40]}'") from None


def positive_number(text: str) -> float:
    """Parse a finite number > 0."""
    try:
        number = float(text) if text.isascii() and "_" not in text else 0.0
    except ValueError:
        number = 0.0
    if not 0 < number < inf:
        raise ArgumentTypeError(f"must be a number > 0, got '{text[:40]}'")
    return number


def exposure(text: str) -> float:
    """Parse an exposure: a number of doublings of light."""
    return number_within(text, -MAX_EXPOSURE, MAX_EXPOSURE)


def text_scale(text: str) -> float:
    """Parse a factor for the size of text."""
    return number_within(text, *TEXT_SCALES)


def number_within(text: str, low: float, high: float) -> float:
    """Parse a number in [low, high]."""
    try:
        number = float(text) if text.isascii() and "_" not in text else inf
    except ValueError:
        number = inf
    if not low <= number <= high:
        raise ArgumentTypeError(f"must be a number from {low:g} to {high:g}, got '{text[:40]}'")
    return number


def memory_size(text: str) -> int:
    """Parse an amount of memory in bytes, or in units of 1024 such as 512M, 1.5G and 2GiB."""
    match = re.fullmatch(r"([0-9]{1,15}(?:\.[0-9]{1,9})?)(?:([kmgt])(?:i?b)?)?", text.lower(), re.ASCII)
    size = int(float(match[1]) * 1024 ** (" kmgt".index(match[2]) if match[2] else 0)) if match else 0
    if not LEAST_MEMORY <= size <= MOST_MEMORY:
        raise ArgumentTypeError(f"must be an amount of memory from 1M to 1024T, like 512M or 4G, got '{text[:40]}'")
    return size

"""Parsers of sizes and numbers on the command line; ArgumentTypeError says what is wrong with a text."""

from __future__ import annotations

from argparse import ArgumentTypeError
from math import inf

MAX_SIDE = 16384  # pixels
MAX_EXPOSURE = 20.0  # EV, up and down


def size(text: str) -> tuple[int, int]:
    """Parse a size in pixels, such as 640x480."""
    width, _, height = text.partition("x")
    if not (width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise ArgumentTypeError(f"must be WIDTHxHEIGHT, like 640x480, got '{text}'")
    return whole_number(width, 1, MAX_SIDE), whole_number(height, 1, MAX_SIDE)


def whole_number(text: str, low: int, high: int) -> int:
    """Parse a whole number in [low, high]."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high):
        raise ArgumentTypeError(f"must be a whole number from {low} to {high}, got '{text[:40]}'")
    return int(text)


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
    try:
        number = float(text) if text.isascii() and "_" not in text else inf
    except ValueError:
        number = inf
    if not -MAX_EXPOSURE <= number <= MAX_EXPOSURE:
        raise ArgumentTypeError(f"must be a number from {-MAX_EXPOSURE:g} to {MAX_EXPOSURE:g}, got '{text[:40]}'")
    return number

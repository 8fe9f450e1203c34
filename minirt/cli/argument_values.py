"""Amounts in the arguments of the program: from text, or what is wrong with it."""

from __future__ import annotations

from argparse import ArgumentTypeError
from math import inf

LARGEST = 16384  # pixels, of a side


def size(text: str) -> tuple[int, int]:
    """A size in pixels, written 640x480."""
    width, _, height = text.partition("x")
    if not (width.isascii() and width.isdigit() and height.isascii() and height.isdigit()):
        raise ArgumentTypeError(f"must be WIDTHxHEIGHT, like 640x480, got '{text}'")
    return whole(width, 1, LARGEST), whole(height, 1, LARGEST)


def whole(text: str, low: int, high: int) -> int:
    """A whole number in [low, high]."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high):
        raise ArgumentTypeError(f"must be a whole number from {low} to {high}, got '{text[:40]}'")
    return int(text)


def above_0(text: str) -> float:
    """A number > 0."""
    try:
        number = float(text) if text.isascii() and "_" not in text else 0.0
    except ValueError:
        number = 0.0
    if not 0 < number < inf:
        raise ArgumentTypeError(f"must be a number > 0, got '{text[:40]}'")
    return number

"""A line of a replay file: its words, their meanings, and errors that point at them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import NoReturn

from minirt.errors import FieldError, Problem, ReplayError, quoted
from minirt.fields import number
from minirt.mlx import Key, Modifier
from minirt.viewer.bindings import KEYS, MODIFIERS, Chord, parse_chord

WORD = re.compile(r"\S+")
PIXEL = re.compile(r"([0-9]{1,5}),([0-9]{1,5})")
SIZE = re.compile(r"([0-9]{1,5})x([0-9]{1,5})")
MAX_PIXELS = 16384  # pixels
MAX_SECONDS = 3600.0  # seconds
MAX_COUNT = 1000  # steps of the wheel
MODIFIER_KEYS = {Modifier.SHIFT: Key.SHIFT_L, Modifier.CTRL: Key.CONTROL_L, Modifier.COMMAND: Key.COMMAND_L}


class Line:
    """The words of a line before its comment. The command has index 0, its arguments follow."""

    def __init__(self, file: str, number_in_file: int, text: str) -> None:
        self.file = file
        self.number = number_in_file
        self.text = text.rstrip("\r\n")
        matches = list(WORD.finditer(self.text))
        end = next((index for index, word in enumerate(matches) if word[0].startswith("#")), len(matches))
        self.words = [word[0] for word in matches[:end]]
        self.columns = [word.start() + 1 for word in matches[:end]]

    def fail(self, index: int, message: str) -> NoReturn:
        """Raise a ReplayError that points at a word."""
        problem = Problem(self.file, self.number, self.columns[index], self.text, message, len(self.words[index]))
        raise ReplayError(str(problem))

    def choice(self, index: int, options: Iterable[str], noun: str) -> str:
        """Return a word that must be one of the options."""
        word, options = self.words[index], list(options)
        if word not in options:
            hint = suggestion(word, options)
            self.fail(index, f"unknown {noun} {quoted(word)}{hint}; expected one of {', '.join(options)}")
        return word

    def chord(self) -> Chord:
        """Parse the argument as a key with or without modifiers, or a character."""
        word = self.words[1]
        if word in MODIFIERS:
            return Chord(MODIFIER_KEYS[MODIFIERS[word]])
        try:
            return parse_chord(word)
        except ValueError as error:
            part = str(error)
            hint = suggestion(part, (*KEYS, *MODIFIERS))
            self.fail(1, f"unknown key {quoted(part)}{hint}; expected a key like Tab, a, F5, Ctrl+S")

    def held_keys(self) -> list[Key]:
        """Parse the argument as a key that can be held; the keys of its modifiers come first."""
        code, modifiers = self.chord()
        if not isinstance(code, Key):
            self.fail(1, f"{quoted(self.words[1])} is typed, not held; expected a key like Left, d or Shift+d")
        return [*(MODIFIER_KEYS[modifier] for modifier in modifiers), code]

    def seconds(self, index: int) -> float:
        """Parse an argument as a time in seconds."""
        try:
            value = number(self.words[index])
        except FieldError:
            value = -1.0
        if not 0 <= value <= MAX_SECONDS:
            self.fail(index, f"expected seconds from 0 to {MAX_SECONDS:g}, got {quoted(self.words[index])}")
        return value

    def count(self, index: int) -> int:
        """Parse an argument as a number of steps, 1 if it is missing."""
        word = self.words[index] if index < len(self.words) else "1"
        if not (word.isascii() and word.isdigit() and 1 <= int(word[:5]) <= MAX_COUNT):
            self.fail(index, f"expected a count from 1 to {MAX_COUNT}, got {quoted(word)}")
        return int(word)

    def pixel(self, index: int = 1) -> tuple[int, int]:
        """Parse an argument as a pixel x,y."""
        return self.pair(PIXEL, 0, "x,y", index)

    def size(self) -> tuple[int, int]:
        """Parse the argument as a size WxH in pixels."""
        return self.pair(SIZE, 1, "WxH")

    def pair(self, pattern: re.Pattern[str], low: int, form: str, index: int = 1) -> tuple[int, int]:
        """Parse an argument as two numbers of pixels."""
        match = pattern.fullmatch(self.words[index])
        if not match or not all(low <= int(part) <= MAX_PIXELS for part in match.groups()):
            self.fail(index, f"expected {form}, each from {low} to {MAX_PIXELS}, got {quoted(self.words[index])}")
        return int(match[1]), int(match[2])


def suggestion(word: str, options: Iterable[str]) -> str:
    """Return `, did you mean 'Tab'?` for a similar option, or an empty string."""
    matches = difflib.get_close_matches(word, list(options), n=1)
    return f", did you mean '{matches[0]}'?" if matches else ""

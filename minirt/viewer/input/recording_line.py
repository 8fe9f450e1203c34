"""A line of a file of recorded keys: its words, what they mean, and errors that point at them."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import NoReturn

from minirt.errors import FieldError, Problem, ReplayError, quoted
from minirt.fields import number
from minirt.mlx import Key, Modifier
from minirt.viewer.input.chords import KEYS, MODIFIERS, Chord, chord

WORD = re.compile(r"\S+")
PLACE = re.compile(r"([0-9]{1,5}),([0-9]{1,5})")
SIZE = re.compile(r"([0-9]{1,5})x([0-9]{1,5})")
LARGEST = 16384  # pixels
LONGEST = 3600.0  # seconds
MOST = 1000  # steps of the wheel
HANDS = {Modifier.SHIFT: Key.SHIFT_L, Modifier.CTRL: Key.CONTROL_L, Modifier.COMMAND: Key.COMMAND_L}


class Line:
    """The words in front of a comment; `index` is that of a word, 0 is the command."""

    def __init__(self, file: str, number_in_file: int, text: str) -> None:
        self.file = file
        self.number = number_in_file
        self.text = text.rstrip("\r\n")
        found = list(WORD.finditer(self.text))
        end = next((index for index, word in enumerate(found) if word[0].startswith("#")), len(found))
        self.words = [word[0] for word in found[:end]]
        self.columns = [word.start() + 1 for word in found[:end]]

    def fail(self, index: int, message: str) -> NoReturn:
        """The error about one of the words."""
        problem = Problem(self.file, self.number, self.columns[index], self.text, message, len(self.words[index]))
        raise ReplayError(str(problem))

    def choice(self, index: int, known: Iterable[str], what: str) -> str:
        """One of the known words."""
        word, known = self.words[index], list(known)
        if word not in known:
            self.fail(index, f"unknown {what} {quoted(word)}{guess(word, known)}; expected one of {', '.join(known)}")
        return word

    def chord(self) -> Chord:
        """A key, with modifiers or without, or a character."""
        word = self.words[1]
        if word in MODIFIERS:
            return Chord(HANDS[MODIFIERS[word]])
        try:
            return chord(word)
        except ValueError as error:
            part = str(error)
            hint = guess(part, (*KEYS, *MODIFIERS))
            self.fail(1, f"unknown key {quoted(part)}{hint}; expected a key like Tab, a, F5, Ctrl+S")

    def held(self) -> list[Key]:
        """A key that can be held, behind those of its modifiers."""
        code, modifiers = self.chord()
        if not isinstance(code, Key):
            self.fail(1, f"{quoted(self.words[1])} is typed, not held; expected a key like Left, d or Shift+d")
        return [*(HANDS[modifier] for modifier in modifiers), code]

    def seconds(self, index: int) -> float:
        """A time."""
        try:
            value = number(self.words[index])
        except FieldError:
            value = -1.0
        if not 0 <= value <= LONGEST:
            self.fail(index, f"expected seconds from 0 to {LONGEST:g}, got {quoted(self.words[index])}")
        return value

    def count(self, index: int) -> int:
        """A number of steps, 1 where there is no such word."""
        word = self.words[index] if index < len(self.words) else "1"
        if not (word.isascii() and word.isdigit() and 1 <= int(word[:5]) <= MOST):
            self.fail(index, f"expected a count from 1 to {MOST}, got {quoted(word)}")
        return int(word)

    def place(self, index: int = 1) -> tuple[int, int]:
        """A pixel: x,y."""
        return self.pair(PLACE, 0, "x,y", index)

    def size(self) -> tuple[int, int]:
        """A size in pixels: WxH."""
        return self.pair(SIZE, 1, "WxH")

    def pair(self, pattern: re.Pattern[str], low: int, what: str, index: int = 1) -> tuple[int, int]:
        """Two numbers of pixels."""
        match = pattern.fullmatch(self.words[index])
        if not match or not all(low <= int(part) <= LARGEST for part in match.groups()):
            self.fail(index, f"expected {what}, each from {low} to {LARGEST}, got {quoted(self.words[index])}")
        return int(match[1]), int(match[2])


def guess(word: str, known: Iterable[str]) -> str:
    """`, did you mean 'Tab'?` or nothing."""
    near = difflib.get_close_matches(word, list(known), n=1)
    return f", did you mean '{near[0]}'?" if near else ""

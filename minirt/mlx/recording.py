"""Recorded input: one command a line; `#` begins a comment. Positions and sizes are pixels of the window.

press KEY            a, 1, F5, PageUp, Ctrl+Shift+S     click x,y [left|middle|right]
hold KEY seconds     down KEY, up KEY                   drag x,y x,y [left|middle|right]
text CHARACTERS      wait seconds                       wheel up|down [count] [x,y]
resize WxH           hide, show, close                  move x,y
drop FILE            window NUMBER                      picture FILE
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from functools import partial
from itertools import takewhile
from pathlib import Path
from typing import Any, NoReturn

from minirt.errors import Problem, ReplayError, did_you_mean, quoted
from minirt.mlx.events import KEYS, Button, Key
from minirt.mlx.memory import Memory

WORD = re.compile(r"\S+")
NUMBER = "([0-9]{1,5})"
MAX_PIXELS = 32767
MAX_SECONDS = 100_000
MAX_COUNT = 1000  # steps of the wheel, windows
MODIFIERS = {"Ctrl": Key.CONTROL_L, "Shift": Key.SHIFT_L, "Alt": Key.ALT_L, "Super": Key.SUPER_L}
BUTTONS = {"left": Button.LEFT, "middle": Button.MIDDLE, "right": Button.RIGHT}
DIRECTIONS = {"up": 1, "down": -1}
DRAG_MOVES, DRAG_SECONDS = 12, 0.4

Keys = list[int]


def add_recording(lines: Iterable[str], file: str, user: Memory, *, types: bool = True) -> None:
    """Add the commands of a recording to the script of `user`. ReplayError for the first command that is wrong.

    types: characters other than letters are typed, as the viewer reads them, and Ctrl is Cmd on macOS; otherwise they
    are pressed, as programs for MiniLibX read them, which know keys alone.
    """
    for number, text in enumerate(lines, 1):
        line = RecordedLine(file, number, text, types=types)
        if line.words:
            usage, run = COMMANDS[line.choice(0, COMMANDS, "command")]
            run(user, *line.arguments(usage))


class RecordedLine:
    """The words of a line before its comment. The command has index 0, its arguments follow."""

    def __init__(self, file: str, number_in_file: int, text: str, *, types: bool = True) -> None:
        self.file = file
        self.number = number_in_file
        self.text = text.rstrip("\r\n")
        self.types = types
        found = list(takewhile(lambda word: word[0][0] != "#", WORD.finditer(self.text)))
        self.words = [word[0] for word in found]
        self.columns = [word.start() + 1 for word in found]

    def arguments(self, usage: str) -> list[Any]:
        """Return the values of the arguments that a usage names; those in brackets may be missing."""
        kinds = usage.split()[1:]
        count, has_rest = len(self.words) - 1, usage.endswith(("CHARACTERS", "FILE"))
        if count < sum(each[0] != "[" for each in kinds) or (count > len(kinds) and not has_rest):
            self.fail(min(count, len(kinds) + 1), f"expected '{usage}'")
        return [READERS[each.strip("[]")](self, index) for index, each in enumerate(kinds[:count], 1)]

    def fail(self, index: int, message: str) -> NoReturn:
        """Raise a ReplayError that points at a word."""
        problem = Problem(self.file, self.number, self.columns[index], self.text, message, len(self.words[index]))
        raise ReplayError(str(problem))

    def choice(self, index: int, options: Iterable[str], noun: str) -> str:
        """Return a word that must be one of the options."""
        word, options = self.words[index], list(options)
        if word not in options:
            hint = did_you_mean(word, options)
            self.fail(index, f"unknown {noun} {quoted(word)}{hint}; expected one of {', '.join(options)}")
        return word

    def keys(self, index: int) -> Keys | str:
        """Parse the key that is the word `index`: return the codes of its modifiers and its own, or a typed character.

        With `types` a character other than a letter is typed, not pressed; only the command "press" can type. A number
        of several digits is a code. ReplayError for any other key.
        """
        word = self.words[index]
        if word in MODIFIERS:
            return [self.modifier(word, index)]
        before, plus, name = word.rpartition("+")
        if plus and not name and before[-1:] in ("", "+"):  # the key itself is +
            before, name = before[:-1], plus
        codes = [self.modifier(each, index) for each in before.split("+")] if before else []
        is_character = len(name) == 1 and not (name.isascii() and name.isalpha())
        if is_character and self.types and not codes:
            if self.words[0] != "press":
                self.fail(index, f"{quoted(word)} is typed, not held; expected a key like Left, d or Shift+d")
            return name
        if len(name) == 1:
            return [*codes, ord(name.lower())]
        if name.isascii() and name.isdigit() and len(name) <= len(str(max(Key))):
            return [*codes, int(name)]
        if name not in KEYS:
            self.unknown_key(name, index)
        return [*codes, KEYS[name]]

    def modifier(self, name: str, index: int) -> int:
        if name not in MODIFIERS:
            self.unknown_key(name, index)
        return Key.COMMAND_L if name == "Ctrl" and self.types and sys.platform == "darwin" else MODIFIERS[name]

    def unknown_key(self, name: str, index: int) -> NoReturn:
        hint = did_you_mean(name, (*KEYS, *MODIFIERS))
        self.fail(index, f"unknown key {quoted(name)}{hint}; expected a key like Tab, a, F5, Ctrl+S or 65307")

    def seconds(self, index: int) -> float:
        try:
            value = float(self.words[index])
        except ValueError:
            value = -1.0
        if not 0 <= value <= MAX_SECONDS:
            self.fail(index, f"expected seconds from 0 to {MAX_SECONDS}, got {quoted(self.words[index])}")
        return value

    def numbers(self, index: int, pattern: str, low: int, high: int, expected: str) -> tuple[int, ...]:
        """Parse the numbers that are the groups of a pattern."""
        match = re.fullmatch(pattern, self.words[index])
        found = tuple(map(int, match.groups())) if match else ()
        if not found or not all(low <= each <= high for each in found):
            self.fail(index, f"expected {expected} from {low} to {high}, got {quoted(self.words[index])}")
        return found


def press(user: Memory, keys: Keys | str) -> None:
    """Press and release keys, or type a character."""
    if isinstance(keys, str):
        user.text(keys)
    else:
        user.tap(*keys)


def hold(user: Memory, keys: Keys, seconds: float) -> None:
    user.press(*keys)
    user.wait(seconds)
    user.release(*reversed(keys))


def text(user: Memory, characters: str) -> None:
    """Type characters one by one."""
    for character in characters.replace(" ", ""):
        user.text(character)


def click(user: Memory, place: tuple[int, int], button: int = Button.LEFT) -> None:
    """Move to a pixel and click."""
    user.motion(*place)
    user.click(*place, button)


def drag(user: Memory, start: tuple[int, int], end: tuple[int, int], button: int = Button.LEFT) -> None:
    """Drag from one pixel to another in a straight line."""
    (x, y), (to_x, to_y) = start, end
    user.motion(x, y)
    user.button_press(button, x, y)
    for step in range(1, DRAG_MOVES + 1):
        user.motion(x + (to_x - x) * step // DRAG_MOVES, y + (to_y - y) * step // DRAG_MOVES)
        user.wait(DRAG_SECONDS / DRAG_MOVES)
    user.button_release(button, to_x, to_y)


READERS: dict[str, Callable[[RecordedLine, int], Any]] = {  # of the arguments of a usage
    "KEY": lambda line, index: line.keys(index),
    "seconds": lambda line, index: line.seconds(index),
    "x,y": lambda line, index: line.numbers(index, f"{NUMBER},{NUMBER}", 0, MAX_PIXELS, "x,y, each"),
    "WxH": lambda line, index: line.numbers(index, f"{NUMBER}x{NUMBER}", 1, MAX_PIXELS, "WxH, each"),
    "left|middle|right": lambda line, index: BUTTONS[line.choice(index, BUTTONS, "button")],
    "up|down": lambda line, index: DIRECTIONS[line.choice(index, DIRECTIONS, "direction")],
    "count": lambda line, index: line.numbers(index, NUMBER, 1, MAX_COUNT, "a count")[0],
    "NUMBER": lambda line, index: line.numbers(index, NUMBER, 1, MAX_COUNT, "a count")[0],
    "CHARACTERS": lambda line, index: " ".join(line.words[index:]),
    "FILE": lambda line, index: " ".join(line.words[index:]),
}
COMMANDS: dict[str, tuple[str, Callable[..., None]]] = {  # by their first words
    usage.split()[0]: (usage, run)
    for usage, run in (
        ("press KEY", press),
        ("hold KEY seconds", hold),
        ("down KEY", lambda user, keys: user.press(*keys)),
        ("up KEY", lambda user, keys: user.release(*reversed(keys))),
        ("text CHARACTERS", text),
        ("wait seconds", lambda user, seconds: user.wait(seconds)),
        ("click x,y [left|middle|right]", click),
        ("drag x,y x,y [left|middle|right]", drag),
        ("move x,y", lambda user, place: user.motion(*place)),
        ("wheel up|down [count] [x,y]", lambda user, up, count=1, place=(): user.scroll(up * count, *place)),
        ("drop FILE", lambda user, file: user.drop(file)),
        ("resize WxH", lambda user, size: user.resize(*size)),
        ("hide", lambda user: user.minimise(True)),
        ("show", lambda user: user.minimise(False)),
        ("close", lambda user: user.close_button()),
        ("window NUMBER", lambda user, number: user.do(partial(setattr, user, "selected", number - 1))),
        ("picture FILE", lambda user, file: user.do(partial(user.save, Path(file)))),
    )
}

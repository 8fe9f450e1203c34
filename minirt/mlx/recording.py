"""Scripts of events: one step a line; `#` begins a comment. Positions are pixels of the window.

press KEY              Escape, a, 1, F5, Shift+a, 65307   click x,y [middle|right]
hold KEY seconds       down KEY, up KEY                   drag x,y x,y [middle|right]
wait seconds           hide, show, close                  wheel up|down [count] [x,y]
window NUMBER          picture FILE                       move x,y
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from minirt.errors import MlxError
from minirt.mlx.events import Button, Key

if TYPE_CHECKING:
    from minirt.mlx.memory import Headless


KEYS = {"".join(map(str.capitalize, key.name.split("_"))): int(key) for key in Key}
MODIFIERS = {"Shift": Key.SHIFT_L, "Ctrl": Key.CONTROL_L, "Alt": Key.ALT_L, "Super": Key.SUPER_L}
BUTTONS = {"left": Button.LEFT, "middle": Button.MIDDLE, "right": Button.RIGHT}
DIRECTIONS = {"up": 1, "down": -1}
MOVES = 10  # of a drag
GREATEST = 100_000  # pixels, seconds, steps

Step = Callable[..., None]


def add_script(lines: Iterable[str], file: str, user: Headless) -> None:
    """Add the steps of a script to those of the user. Raises MlxError for the first line that is wrong."""
    for number, line in enumerate(lines, 1):
        command, *arguments = line.split("#")[0].split() or [""]
        if not command:
            continue
        try:
            if command not in STEPS:
                raise ValueError(f"unknown command {command!r}; expected one of {', '.join(STEPS)}")
            STEPS[command](user, *arguments)
        except ValueError as error:
            raise MlxError(f"{file}:{number}: {error}") from error
        except TypeError as error:  # too few arguments, or too many
            raise MlxError(f"{file}:{number}: wrong number of arguments for {command!r}") from error


def key_codes(text: str) -> list[int]:
    """Return the codes of a key with the codes of its modifiers before. Raises ValueError."""
    *modifiers, name = text.split("+") if len(text) > 1 else [text]
    if unknown := next((word for word in modifiers if word not in MODIFIERS), None):
        raise ValueError(f"unknown modifier {unknown!r}; expected one of {', '.join(MODIFIERS)}")
    codes: list[int] = [MODIFIERS[word] for word in modifiers]
    if len(name) == 1:
        return [*codes, ord(name.lower())]
    if name.isascii() and name.isdigit():
        return [*codes, int(name)]
    if name not in KEYS:
        raise ValueError(f"unknown key {name!r}; expected one like a, 1, Escape, PageUp, F5, Shift+a or 65307")
    return [*codes, KEYS[name]]


def press(user: Headless, key: str) -> None:
    """Press and release a key."""
    down(user, key)
    up(user, key)


def hold(user: Headless, key: str, seconds: str) -> None:
    """Hold a key down for some seconds."""
    down(user, key)
    user.wait(amount(seconds))
    up(user, key)


def down(user: Headless, key: str) -> None:
    """Press a key and its modifiers."""
    for code in key_codes(key):
        user.press(code)


def up(user: Headless, key: str) -> None:
    """Release a key and its modifiers."""
    for code in reversed(key_codes(key)):
        user.release(code)


def click(user: Headless, place: str, button: str = "left") -> None:
    """Click at a place."""
    user.motion(*position(place))
    user.click(*position(place), one_of(BUTTONS, button))


def drag(user: Headless, start: str, end: str, button: str = "left") -> None:
    """Drag in a straight line."""
    (x, y), (to_x, to_y) = position(start), position(end)
    user.motion(x, y)
    user.button_press(one_of(BUTTONS, button), x, y)
    for move in range(1, MOVES + 1):
        user.motion(x + (to_x - x) * move // MOVES, y + (to_y - y) * move // MOVES)
    user.button_release(one_of(BUTTONS, button), to_x, to_y)


def wheel(user: Headless, direction: str, count: str = "1", place: str = "0,0") -> None:
    """Turn the wheel."""
    user.scroll(one_of(DIRECTIONS, direction) * int(amount(count)), *position(place))


def window(user: Headless, number: str) -> None:
    """Let the next steps act on another window; they are numbered from 1, the oldest first."""
    user.do(partial(setattr, user, "selected", max(1, int(amount(number))) - 1))


def amount(text: str) -> float:
    """Return a number. Raises ValueError."""
    value = float(text)
    if not 0 <= value <= GREATEST:
        raise ValueError(f"expected a number from 0 to {GREATEST}, got {text}")
    return value


def position(text: str) -> tuple[int, int]:
    """Return the numbers of x,y. Raises ValueError."""
    found = re.fullmatch(r"(\d{1,5}),(\d{1,5})", text)
    if not found:
        raise ValueError(f"expected x,y in pixels, got {text!r}")
    return int(found[1]), int(found[2])


def one_of(options: dict[str, Button] | dict[str, int], word: str) -> int:
    """Return the value of a word. Raises ValueError."""
    if word not in options:
        raise ValueError(f"expected one of {', '.join(options)}, got {word!r}")
    return options[word]


STEPS: dict[str, Step] = {
    "press": press,
    "hold": hold,
    "down": down,
    "up": up,
    "wait": lambda user, seconds: user.wait(amount(seconds)),
    "click": click,
    "drag": drag,
    "move": lambda user, place: user.motion(*position(place)),
    "wheel": wheel,
    "hide": lambda user: user.minimise(True),
    "show": lambda user: user.minimise(False),
    "close": lambda user: user.close_button(),
    "window": window,
    "picture": lambda user, file: user.do(partial(user.save, Path(file))),
}

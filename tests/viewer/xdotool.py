"""Recorded keys and mouse events in a real window: xdotool performs the lines that `miniRT --replay` plays."""

from __future__ import annotations

from minirt.mlx.recording import RecordedLine
from tests.windows import Desktop

NAMES = {
    "+": "plus",
    "-": "minus",
    "=": "equal",
    ",": "comma",
    ".": "period",
    "?": "question",
    "PageUp": "Prior",
    "Backspace": "BackSpace",
}
BUTTONS = {"left": "1", "middle": "2", "right": "3", "up": "4", "down": "5"}


LETTER_KEYS = {"q": 24, "a": 38, "z": 52}  # key codes of the first letters of each row of an American keyboard
LETTER_CODES = {
    letter: str(LETTER_KEYS[row[0]] + n)
    for row in ("qwertyuiop", "asdfghjkl", "zxcvbnm")
    for n, letter in enumerate(row)
}


def name(key: str, codes: dict[str, str] | None = None) -> str:
    """Return xdotool's name of a key or chord: ctrl+shift+s for `Ctrl+Shift+S`.

    `codes`: key codes of letters that the keyboard does not print; xdotool would put them on a key of its own.
    """
    *modifiers, last = [*key[:-1].split("+")[:-1], key[-1]] if key[-1] == "+" else key.split("+")
    last = NAMES.get(last, last.lower() if len(last) == 1 else last)
    return "+".join([*(word.lower() for word in modifiers), (codes or {}).get(last, last)])


def command(window: int, words: list[str], codes: dict[str, str] | None = None) -> list[str]:
    """Return the arguments of xdotool that perform a line; it waits only if the line says so. `codes`: as in `name`."""
    at = ["mousemove", "--window", str(window)]
    match words:
        case ["press" | "down" | "up" as how, key]:
            arguments = [{"press": "key", "down": "keydown", "up": "keyup"}[how], "--delay", "0", name(key, codes)]
        case ["text", characters]:
            arguments = ["type", "--delay", "0", characters]
        case ["move", place]:
            arguments = [*at, *place.split(",")]
        case ["click", place, *button]:
            arguments = [*at, *place.split(","), "click", "--delay", "0", BUTTONS[button[0] if button else "left"]]
        case ["wheel", way, *count]:
            arguments = ["click", "--delay", "0", "--repeat", count[0] if count else "1", BUTTONS[way]]
        case ["drag", start, end, *button]:
            number = BUTTONS[button[0] if button else "left"]
            (x, y), (to_x, to_y) = (map(int, place.split(",")) for place in (start, end))
            moves = [*at, str((x + to_x) // 2), str((y + to_y) // 2), *at, str(to_x), str(to_y)]
            arguments = [*at, str(x), str(y), "mousedown", number, *moves, "mouseup", number]
        case ["wait", seconds]:
            arguments = ["sleep", seconds]
        case ["resize", size]:
            arguments = ["windowsize", str(window), *size.split("x")]
        case _:
            raise ValueError(words)
    return arguments


def do(desktop: Desktop, window: int, *lines: str, codes: dict[str, str] | None = None) -> None:
    """Perform the lines, one after the other; `codes` as in `name`."""
    arguments: list[str] = []
    for line in lines:
        match RecordedLine("xdotool", 1, line).words:
            case ["hide" | "show" as how]:
                xdotool(desktop, arguments)
                arguments = []
                (desktop.minimise if how == "hide" else desktop.restore)(window)
            case words:
                arguments += command(window, words, codes)
    xdotool(desktop, arguments)


def xdotool(desktop: Desktop, arguments: list[str]) -> None:
    """Run xdotool, if there are any arguments."""
    if arguments:
        desktop.run("xdotool", *arguments)

"""Replays in a real window: the same lines that `miniRT --replay` plays, done by xdotool."""

from __future__ import annotations

from minirt.viewer.input.recording_line import Line
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


def name(key: str) -> str:
    """A key or chord as xdotool calls it: `Ctrl+Shift+S` is ctrl+shift+s."""
    if key in NAMES:
        return NAMES[key]
    *held, last = key.split("+")
    last = NAMES.get(last, last.lower() if len(last) == 1 else last)
    return "+".join([*(word.lower() for word in held), last])


def command(window: int, words: list[str]) -> list[str]:
    """The arguments of xdotool that do a line. It waits nowhere but where the line says so."""
    at = ["mousemove", "--window", str(window)]
    match words:
        case ["press" | "down" | "up" as how, key]:
            found = [{"press": "key", "down": "keydown", "up": "keyup"}[how], "--delay", "0", name(key)]
        case ["move", place]:
            found = [*at, *place.split(",")]
        case ["click", place, *button]:
            found = [*at, *place.split(","), "click", "--delay", "0", BUTTONS[button[0] if button else "left"]]
        case ["wheel", way, *count]:
            found = ["click", "--delay", "0", "--repeat", count[0] if count else "1", BUTTONS[way]]
        case ["drag", start, end, *button]:
            number = BUTTONS[button[0] if button else "left"]
            (x, y), (to_x, to_y) = (map(int, place.split(",")) for place in (start, end))
            moves = [*at, str((x + to_x) // 2), str((y + to_y) // 2), *at, str(to_x), str(to_y)]
            found = [*at, str(x), str(y), "mousedown", number, *moves, "mouseup", number]
        case ["wait", seconds]:
            found = ["sleep", seconds]
        case ["resize", size]:
            found = ["windowsize", str(window), *size.split("x")]
        case _:
            raise ValueError(words)
    return found


def do(desktop: Desktop, window: int, *lines: str) -> None:
    """Do the lines, one after the other."""
    arguments: list[str] = []
    for line in lines:
        match Line("hands", 1, line).words:
            case ["hide" | "show" as how]:
                xdotool(desktop, arguments)
                arguments = []
                (desktop.minimise if how == "hide" else desktop.restore)(window)
            case words:
                arguments += command(window, words)
    xdotool(desktop, arguments)


def xdotool(desktop: Desktop, arguments: list[str]) -> None:
    if arguments:
        desktop.run("xdotool", *arguments)

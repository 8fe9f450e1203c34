"""Files of recorded keys: one command a line, `#` begins a comment.

Places and sizes are in pixels.

    press KEY              Tab, a, F5, +, Ctrl+Shift+S       click x,y [right]
    hold KEY seconds       down KEY, up KEY                  drag x,y x,y [right|middle]
    text CHARACTERS        wait seconds                      wheel up|down [count]
    resize WxH             hide, show, close                 move x,y
    drop FILE
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from minirt.mlx import Button
from minirt.mlx.memory import Memory
from minirt.viewer.input.recording_line import HANDS, Line

DRAGGED = {"left": Button.LEFT, "middle": Button.MIDDLE, "right": Button.RIGHT}
STEPS, DRAG = 12, 0.4  # movements and seconds of a drag


def record(lines: Iterable[str], file: str, memory: Memory) -> None:
    """Add the commands to the script of a back end without a screen. ReplayError for the first that is wrong."""
    for number, text in enumerate(lines, 1):
        line = Line(file, number, text)
        if line.words:
            do, usage, least, most = COMMANDS[line.choice(0, COMMANDS, "command")]
            given = len(line.words) - 1
            if not least <= given <= most:
                line.fail(min(given, most + 1), f"expected '{usage}'")
            do(line, memory)


def press(line: Line, memory: Memory) -> None:
    """Press and release, or type."""
    code, modifiers = line.chord()
    if isinstance(code, str):
        memory.text(code)
    else:
        memory.tap(*(HANDS[modifier] for modifier in modifiers), code)


def hold(line: Line, memory: Memory) -> None:
    """Press, wait, release."""
    down(line, memory)
    memory.wait(line.seconds(2))
    up(line, memory)


def down(line: Line, memory: Memory) -> None:
    for key in line.held():
        memory.press(key)


def up(line: Line, memory: Memory) -> None:
    for key in reversed(line.held()):
        memory.release(key)


def typed(line: Line, memory: Memory) -> None:
    """Each character by itself."""
    for character in "".join(line.words[1:]):
        memory.text(character)


def click(line: Line, memory: Memory) -> None:
    right = len(line.words) > 2 and line.choice(2, ["right"], "button")
    memory.click(*line.place(), Button.RIGHT if right else Button.LEFT)


def drag(line: Line, memory: Memory) -> None:
    """From a pixel to another, straight."""
    name = line.choice(3, DRAGGED, "button") if len(line.words) > 3 else "left"
    (x, y), (to_x, to_y) = line.place(1), line.place(2)
    memory.button_press(DRAGGED[name], x, y)
    for step in range(1, STEPS + 1):
        memory.motion(x + (to_x - x) * step // STEPS, y + (to_y - y) * step // STEPS)
        memory.wait(DRAG / STEPS)
    memory.button_release(DRAGGED[name], to_x, to_y)


def wheel(line: Line, memory: Memory) -> None:
    sign = 1 if line.choice(1, ["up", "down"], "way") == "up" else -1
    memory.scroll(sign * line.count(2), 0, 0)


def drop(line: Line, memory: Memory) -> None:
    """A file; its name may have blanks in it."""
    memory.drop(" ".join(line.words[1:]))


Command = tuple[Callable[[Line, Memory], None], str, int, int]  # with its usage, and how many words follow it

COMMANDS: dict[str, Command] = {
    "press": (press, "press KEY", 1, 1),
    "hold": (hold, "hold KEY seconds", 2, 2),
    "down": (down, "down KEY", 1, 1),
    "up": (up, "up KEY", 1, 1),
    "text": (typed, "text CHARACTERS", 1, 100),
    "wait": (lambda line, memory: memory.wait(line.seconds(1)), "wait seconds", 1, 1),
    "click": (click, "click x,y [right]", 1, 2),
    "drag": (drag, "drag x,y x,y [right|middle]", 2, 3),
    "drop": (drop, "drop FILE", 1, 100),
    "move": (lambda line, memory: memory.motion(*line.place()), "move x,y", 1, 1),
    "wheel": (wheel, "wheel up|down [count]", 1, 2),
    "resize": (lambda line, memory: memory.resize(*line.size()), "resize WxH", 1, 1),
    "hide": (lambda _, memory: memory.minimise(True), "hide", 0, 0),
    "show": (lambda _, memory: memory.minimise(False), "show", 0, 0),
    "close": (lambda _, memory: memory.close_button(), "close", 0, 0),
}

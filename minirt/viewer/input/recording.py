"""Replay files: recorded input, one command a line; `#` begins a comment. Positions and sizes are in pixels.

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
from minirt.viewer.input.recording_line import MODIFIER_KEYS, Line

BUTTONS = {"left": Button.LEFT, "middle": Button.MIDDLE, "right": Button.RIGHT}
DRAG_MOVES, DRAG_SECONDS = 12, 0.4


def add_recording(lines: Iterable[str], file: str, memory: Memory) -> None:
    """Add the commands of a replay file to the script of `memory`. ReplayError for the first command that is wrong."""
    for number, text in enumerate(lines, 1):
        line = Line(file, number, text)
        if line.words:
            run, usage, least, most = COMMANDS[line.choice(0, COMMANDS, "command")]
            count = len(line.words) - 1
            if not least <= count <= most:
                line.fail(min(count, most + 1), f"expected '{usage}'")
            run(line, memory)


def press(line: Line, memory: Memory) -> None:
    """Press and release a key, or type a character."""
    code, modifiers = line.chord()
    if isinstance(code, str):
        memory.text(code)
    else:
        memory.tap(*(MODIFIER_KEYS[modifier] for modifier in modifiers), code)


def hold(line: Line, memory: Memory) -> None:
    """Hold a key down for some seconds."""
    down(line, memory)
    memory.wait(line.seconds(2))
    up(line, memory)


def down(line: Line, memory: Memory) -> None:
    """Press a key and its modifiers."""
    for key in line.held_keys():
        memory.press(key)


def up(line: Line, memory: Memory) -> None:
    """Release a key and its modifiers."""
    for key in reversed(line.held_keys()):
        memory.release(key)


def text(line: Line, memory: Memory) -> None:
    """Type characters one by one."""
    for character in "".join(line.words[1:]):
        memory.text(character)


def click(line: Line, memory: Memory) -> None:
    """Click at a pixel."""
    right = len(line.words) > 2 and line.choice(2, ["right"], "button")
    memory.click(*line.pixel(), Button.RIGHT if right else Button.LEFT)


def drag(line: Line, memory: Memory) -> None:
    """Drag from one pixel to another in a straight line."""
    name = line.choice(3, BUTTONS, "button") if len(line.words) > 3 else "left"
    (x, y), (to_x, to_y) = line.pixel(1), line.pixel(2)
    memory.button_press(BUTTONS[name], x, y)
    for step in range(1, DRAG_MOVES + 1):
        memory.motion(x + (to_x - x) * step // DRAG_MOVES, y + (to_y - y) * step // DRAG_MOVES)
        memory.wait(DRAG_SECONDS / DRAG_MOVES)
    memory.button_release(BUTTONS[name], to_x, to_y)


def wheel(line: Line, memory: Memory) -> None:
    """Turn the wheel."""
    sign = 1 if line.choice(1, ["up", "down"], "direction") == "up" else -1
    memory.scroll(sign * line.count(2), 0, 0)


def drop(line: Line, memory: Memory) -> None:
    """Drop a file on the window; its name may contain blanks."""
    memory.drop(" ".join(line.words[1:]))


Command = tuple[
    Callable[[Line, Memory], None], str, int, int
]  # function, usage, least and greatest number of arguments

COMMANDS: dict[str, Command] = {
    "press": (press, "press KEY", 1, 1),
    "hold": (hold, "hold KEY seconds", 2, 2),
    "down": (down, "down KEY", 1, 1),
    "up": (up, "up KEY", 1, 1),
    "text": (text, "text CHARACTERS", 1, 100),
    "wait": (lambda line, memory: memory.wait(line.seconds(1)), "wait seconds", 1, 1),
    "click": (click, "click x,y [right]", 1, 2),
    "drag": (drag, "drag x,y x,y [right|middle]", 2, 3),
    "drop": (drop, "drop FILE", 1, 100),
    "move": (lambda line, memory: memory.motion(*line.pixel()), "move x,y", 1, 1),
    "wheel": (wheel, "wheel up|down [count]", 1, 2),
    "resize": (lambda line, memory: memory.resize(*line.size()), "resize WxH", 1, 1),
    "hide": (lambda _, memory: memory.minimise(True), "hide", 0, 0),
    "show": (lambda _, memory: memory.minimise(False), "show", 0, 0),
    "close": (lambda _, memory: memory.close_button(), "close", 0, 0),
}

"""The one table of what keys and mouse do: the handler, the help in the window, `--list-keys` and the README follow it.

A binding that says `held` goes on for as long as its key is held; one that says `fine` makes a tenth of its step with
Shift, save for typed characters: many a keyboard needs Shift to type them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby

from minirt.viewer.input.chords import shown
from minirt.viewer.input.layouts import detect

Group = tuple[str, list[tuple[str, str]]]  # title, rows of keys and help


@dataclass(frozen=True)
class Binding:
    """One row; `minirt.viewer.input.chords` tells how keys are spelled."""

    action: str
    group: str
    help: str
    keys: tuple[str, ...]
    azerty: str = ""  # in the place of the first key, on such a keyboard
    held: bool = False
    fine: bool = False

    def spellings(self, layout: str) -> tuple[str, ...]:
        """Its keys on a keyboard of that layout."""
        return (self.azerty, *self.keys[1:]) if layout == "azerty" and self.azerty else self.keys


def row(group: str, action: str, help: str, *keys: str) -> Binding:
    """Something that happens once for each press."""
    return Binding(action, group, help, keys)


def motion(group: str, action: str, help: str, key: str, azerty: str = "") -> Binding:
    """A movement that goes on while its key is held."""
    return Binding(action, group, help, (key,), azerty, held=True, fine=True)


def steps(group: str, action: str, help: str, *keys: str) -> Binding:
    """A change by one step for each press, or by a tenth of it."""
    return Binding(action, group, help, keys, fine=True)


SELECT, MOVE, CHANGE, EDIT, FILE, WINDOW = "Select", "Move", "Change", "Edit", "File", "Window"

BINDINGS = (
    row(SELECT, "select next", "select the next element", "Tab"),
    row(SELECT, "select previous", "select the previous element", "Shift+Tab"),
    row(SELECT, "select at pointer", "select what the pointer is on", "left click"),
    row(SELECT, "select camera", "back to the camera", "C", "Backspace", "right click"),
    row(SELECT, "select light", "select the next light", "L"),
    motion(MOVE, "left", "move left", "A", "Q"),
    motion(MOVE, "right", "move right", "D"),
    motion(MOVE, "forward", "move forward", "W", "Z"),
    motion(MOVE, "back", "move back", "S"),
    motion(MOVE, "down", "move down", "Q", "A"),
    motion(MOVE, "up", "move up", "E"),
    motion(MOVE, "turn left", "turn left", "Left"),
    motion(MOVE, "turn right", "turn right", "Right"),
    motion(MOVE, "turn up", "turn up", "Up"),
    motion(MOVE, "turn down", "turn down", "Down"),
    row(MOVE, "roll left", "roll counter-clockwise", ","),
    row(MOVE, "roll right", "roll clockwise", "."),
    row(MOVE, "next frame", "move objects in the view, or along X, Y, Z", "X"),
    row(MOVE, "move by hand", "move what the pointer is on; on nothing: look around", "left drag"),
    row(MOVE, "turn by hand", "turn what the pointer is on", "Shift+left drag"),
    row(MOVE, "orbit", "lead the camera round what is selected", "right drag"),
    row(MOVE, "pan", "slide the camera", "middle drag"),
    steps(CHANGE, "grow", "increase the active value", "+", "=", "wheel up"),
    steps(CHANGE, "shrink", "decrease the active value", "-", "wheel down"),
    row(CHANGE, "next value", "which value: diameter, height, colour, ...", "V"),
    row(CHANGE, "give attribute", "add an attribute: highlight, mirror, ...; again: the next", "M"),
    row(CHANGE, "take attribute", "remove the attribute of the active value", "Shift+M"),
    row(CHANGE, "look at", "bring the selected element into view", "F"),
    row(CHANGE, "reset camera", "the camera as it is in the file", "Home", "R"),
    row(EDIT, "undo", "undo", "Ctrl+Z"),
    row(EDIT, "redo", "redo", "Ctrl+Shift+Z", "Ctrl+Y"),
    row(EDIT, "add", "add something; again: of the next kind", "N"),
    row(EDIT, "add previous", "add something; again: of the previous kind", "Shift+N"),
    row(EDIT, "duplicate", "duplicate the selected element", "Ctrl+D"),
    row(EDIT, "delete", "delete the selected element", "Delete"),
    row(FILE, "save", "save the scene", "Ctrl+S"),
    row(FILE, "save copy", "save a copy: name-1.rt", "Ctrl+Shift+S"),
    row(FILE, "screenshot", "save the picture: name-1.png", "P", "F12"),
    row(FILE, "reload", "read the file again", "Ctrl+R", "F5"),
    row(FILE, "copy camera", "copy the camera's line", "Ctrl+C"),
    row(WINDOW, "toggle HUD", "information: a line, all, none", "I"),
    row(WINDOW, "toggle icons", "lights as icons, on or off", "G"),
    row(WINDOW, "toggle help", "this help on or off", "H", "?", "F1"),
    row(WINDOW, "toggle full screen", "full screen on or off", "Ctrl+F", "F11"),
    row(WINDOW, "quit", "quit", "Escape", "Ctrl+Q"),
)

FINE = ("Shift", "hold it for a tenth of the step")  # not an action: the note below each list of keys


def groups(layout: str) -> Iterator[Group]:
    """The rows of the table with the keys of a layout."""
    for title, rows in groupby(BINDINGS, key=lambda binding: binding.group):
        yield title, [(" / ".join(map(shown, binding.spellings(layout))), binding.help) for binding in rows]


def keys_text(layout: str = "auto") -> str:
    """What `--list-keys` prints."""
    listed = [*groups(detect(layout)), ("", [FINE])]
    width = max(len(keys) for _, rows in listed for keys, _ in rows)
    lines = []
    for title, rows in listed:
        lines += ["", title] if title else [""]
        lines += [f"  {keys:{width}}  {help}" for keys, help in rows]
    return "\n".join(lines[1:])


def keys_markdown() -> str:
    """The README's table."""
    lines = ["| action | keys | AZERTY |", "|---|---|---|"]
    for binding in BINDINGS:
        azerty = f"`{binding.azerty}`" if binding.azerty else ""
        lines.append(f"| {binding.help} | {' '.join(f'`{key}`' for key in binding.keys)} | {azerty} |")
    lines.append(f"| {FINE[1]} | `{FINE[0]}` | |")
    return "\n".join(lines) + "\n"

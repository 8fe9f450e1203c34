"""Table of key and mouse bindings, from which the handler, the help, `--list-keys` and the documentation are made.

The action of a `held` binding goes on while its key is held, and takes a tenth of its step with Shift.

Chords are spelled `Tab`, `Shift+Tab`, `Ctrl+Z`, `+`, `wheel up`. Letters and named keys are keys; any other character
is typed text, wherever a keyboard has it, and with Ctrl the key that prints it, with or without Shift: `Ctrl++`. Ctrl
means Cmd on macOS. On QWERTZ keyboards all letters of the bindings are where QWERTY has them.
"""

from __future__ import annotations

import locale
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Any, Final

from minirt.mlx.events import KEYS, Button, Key, Modifier
from minirt.viewer.language import searchable

PRINTED = {"+": Key.PLUS, "-": Key.MINUS, "=": Key.EQUAL, "0": Key.DIGIT_0}  # with Ctrl, by what they print
MODIFIERS = {"Ctrl": Modifier.ACCEL, "Shift": Modifier.SHIFT, "Alt": Modifier.ALT}
PLATFORM_NAMES = {"Ctrl": "Cmd"} if sys.platform == "darwin" else {}
LAYOUTS: Final = ("auto", "qwerty", "azerty", "qwertz")
AZERTY_LOCALES = ("fr_FR", "fr_BE", "French_France", "French_Belgium")  # locales whose usual keyboard is AZERTY
Chord = tuple[int | str, Modifier]  # a key, typed text, a mouse button or a drag, and the held modifiers
KeyGroup = tuple[str, list[tuple[str, str]]]  # title, rows of keys and help
SELECT, LOOK, MOVE, BUILD = "Select", "Look around", "Move and turn", "Build"
CHANGE, FILE, WINDOW = "Change values", "Save and open", "Window"
FINE_NOTE = ("Shift", "hold it for a tenth of the step")  # not an action: a note below each list of keys
SIGNIFICANT = Modifier.ACCEL | Modifier.SHIFT | Modifier.ALT

MOUSE: dict[str, Button | str] = {
    **{f"{each.name.lower()} click": each for each in (Button.LEFT, Button.RIGHT)},
    "double click": "double click",
    **{f"{each} drag": f"{each} drag" for each in ("left", "middle", "right")},
    "wheel up": Button.WHEEL_UP,
    "wheel down": Button.WHEEL_DOWN,
}


def parse_chord(spelling: str) -> Chord:
    """Parse the spelling of a chord of the table. KeyError for an unknown key or modifier."""
    before, plus, name = spelling.rpartition("+")
    if plus and not name:  # the key itself is +
        before, name = before[:-1], plus
    modifiers = Modifier.NONE
    for word in filter(None, before.split("+")):
        modifiers |= MODIFIERS[word]
    if name in MOUSE:
        return MOUSE[name], modifiers
    if len(name) == 1 and not name.isalpha():
        return PRINTED[name] if modifiers else name, modifiers
    return KEYS[name.upper() if len(name) == 1 else name], modifiers


def platform_spelling(spelling: str) -> str:
    """Spelling of a chord with the modifier names of this platform."""
    return "+".join(PLATFORM_NAMES.get(word, word) for word in spelling.split("+")) if len(spelling) > 1 else spelling


def resolve_layout(layout: str, letter_at: Callable[[str], str] = lambda _: "") -> str:
    """Replace `auto` by the layout of the keyboard, or where nothing tells its letters of the user's locale.

    `letter_at` gives the letter of a key by the one on American keyboards. Other layouts than `auto` stay.
    """
    if layout != "auto":
        return layout
    first = letter_at("q")
    if first == "a":
        return "azerty"
    if first:
        return "qwertz" if letter_at("y") == "z" else "qwerty"
    return "azerty" if locale.getlocale()[0] in AZERTY_LOCALES else "qwerty"


@dataclass(frozen=True)
class Binding:
    """One row of the table; `minirt.viewer.bindings` describes the spelling of keys."""

    action: str
    group: str
    help: str
    keys: tuple[str, ...]
    azerty: str = ""  # replaces the first key on an AZERTY keyboard
    held: bool = False

    def spellings(self, layout: str) -> tuple[str, ...]:
        """Keys of the binding on a keyboard of this layout."""
        return (self.azerty, *self.keys[1:]) if layout == "azerty" and self.azerty else self.keys


def once(group: str, action: str, help: str, *keys: str, **options: Any) -> Binding:
    """Binding of an action that happens once for each press."""
    return Binding(action, group, help, keys, **options)


while_held = partial(once, held=True)

BINDINGS = (
    once(SELECT, "select next", "select the next element", "Tab"),
    once(SELECT, "select previous", "select the previous element", "Shift+Tab"),
    once(SELECT, "select at pointer", "select the element under the pointer", "left click"),
    once(SELECT, "select too", "add it to the selected ones, which move together, or remove it", "Shift+left click"),
    once(SELECT, "open menu", "list of what can be done with what is under the pointer", "right click"),
    once(SELECT, "select camera", "select the camera; again: look through the next one", "C", "Backspace"),
    once(SELECT, "select light", "select the next light", "L"),
    once(LOOK, "orbit", "orbit the camera around what is under the pointer", "right drag"),
    once(LOOK, "pan", "slide the camera", "middle drag"),
    once(LOOK, "nearer", "nearer to what is under the pointer", "wheel up"),
    once(LOOK, "farther", "farther from what is under the pointer", "wheel down"),
    once(LOOK, "look at", "bring the selected element into view; again, and of the camera: the scene", "F"),
    once(LOOK, "focus", "focus the camera on what is under the pointer", "Shift+F"),
    once(LOOK, "look through", "look through the selected further camera", "Shift+C", "double click"),
    once(LOOK, "reset camera", "reset the camera to that of the file", "Home", "R"),
    once(LOOK, "explain pixel", "explain the pixel under the pointer: its rays and lights; again: hide them", "Y"),
    once(LOOK, "next view", "next view: normals, depth, shapes, colours", "O"),
    once(LOOK, "next tone", "next tone: plain, srgb, filmic", "T"),
    while_held(MOVE, "left", "move left", "A", azerty="Q"),
    while_held(MOVE, "right", "move right", "D"),
    while_held(MOVE, "forward", "move forward", "W", azerty="Z"),
    while_held(MOVE, "back", "move back", "S"),
    while_held(MOVE, "down", "move down", "Q", azerty="A"),
    while_held(MOVE, "up", "move up", "E"),
    while_held(MOVE, "turn left", "turn left", "Left"),
    while_held(MOVE, "turn right", "turn right", "Right"),
    while_held(MOVE, "turn up", "turn up", "Up"),
    while_held(MOVE, "turn down", "turn down", "Down"),
    once(MOVE, "roll left", "roll counter-clockwise", ","),
    once(MOVE, "roll right", "roll clockwise", "."),
    once(MOVE, "next frame", "move objects in the view, or along X, Y, Z", "X"),
    once(MOVE, "move by hand", "move the element under the pointer; on nothing: look around", "left drag"),
    once(MOVE, "turn by hand", "turn the element under the pointer", "Shift+left drag"),
    once(BUILD, "add", "add an element at the pointer, from a list: type, arrows, Enter; again: the next kind", "N"),
    once(BUILD, "add previous", "the same; again: the previous kind", "Shift+N"),
    once(BUILD, "duplicate", "duplicate the selected element", "Ctrl+D"),
    once(BUILD, "delete", "delete the selected element", "Delete"),
    once(BUILD, "drop", "drop the element onto what lies beneath, on a grid", "B"),
    once(BUILD, "place by hand", "move it on what lies behind, on a grid", "Ctrl+left drag"),
    once(BUILD, "slide by hand", "slide it along surfaces, turned to them", "Alt+left drag", "Ctrl+Shift+left drag"),
    once(BUILD, "undo", "undo", "Ctrl+Z"),
    once(BUILD, "redo", "redo", "Ctrl+Shift+Z", "Ctrl+Y"),
    once(CHANGE, "grow", "increase the active value", "+", "Shift+wheel up"),
    once(CHANGE, "shrink", "decrease the active value", "-", "Shift+wheel down"),
    once(
        CHANGE,
        "type value",
        "type the active value: 3.5 Enter, or = -3 Enter, = *=2 Enter; Tab: and the next",
        "=",
    ),
    once(CHANGE, "next value", "next value: diameter, height, colour, ..., position, direction", "V"),
    once(CHANGE, "previous value", "previous value", "Shift+V"),
    once(CHANGE, "choose colour", "colour, from a list of words", "U"),
    once(CHANGE, "choose second colour", "second colour: of a pattern", "Shift+U"),
    once(CHANGE, "add attribute", "add an attribute from a list: type, arrows, Enter; again: the next", "M"),
    once(CHANGE, "rename", "name the selected element: type, Enter; the file has it as a comment", "F2"),
    once(CHANGE, "remove attribute", "remove the attribute of the active value", "Shift+M"),
    once(FILE, "save", "save the scene", "Ctrl+S"),
    once(FILE, "save copy", "save a copy: name-1.rt", "Ctrl+Shift+S"),
    once(FILE, "screenshot", "save the picture: name-1.png", "P", "F12"),
    once(FILE, "reload", "read the file again", "Ctrl+R", "F5"),
    once(FILE, "copy camera", "copy the camera's line", "Ctrl+C"),
    once(WINDOW, "toggle HUD", "information: a line, all, none", "I"),
    once(WINDOW, "toggle icons", "lights as icons, on or off", "G"),
    once(WINDOW, "toggle handles", "handles on the selected element, on or off", "K"),
    once(WINDOW, "toggle help", "this help, or the picture", "H", "?"),
    once(WINDOW, "toggle panel", "panel of elements, values, history, pictures and films, or no panel", "F1"),
    once(WINDOW, "larger text", "larger text and icons", "Ctrl++", "Ctrl+="),
    once(WINDOW, "smaller text", "smaller text and icons", "Ctrl+-"),
    once(WINDOW, "usual text", "text of the usual size", "Ctrl+0"),
    once(WINDOW, "toggle full screen", "full screen on or off", "Ctrl+F", "F11"),
    once(WINDOW, "quit", "quit", "Escape", "Ctrl+Q"),
)


BY_ACTION = {each.action: each for each in BINDINGS}


def keys_of(action: str, layout: str) -> tuple[str, ...]:
    """Return the keys of an action on a keyboard of this layout, with the names of this platform; none of a tool."""
    return tuple(map(platform_spelling, BY_ACTION[action].spellings(layout))) if action in BY_ACTION else ()


def key_groups(layout: str, search: str = "", translate: Callable[[str], str] = str) -> Iterator[KeyGroup]:
    """Yield the rows of the table by group, with the keys of a layout, and then a note without a title.

    `search`: letters that a row, or the title of its group, contains; `translate` is given titles and help.
    """
    for title, bindings in groupby(BINDINGS, key=lambda binding: binding.group):
        rows = [
            (" / ".join(translate(platform_spelling(key)) for key in each.spellings(layout)), translate(each.help))
            for each in bindings
        ]
        if found := [row for row in rows if search in searchable(" ".join((translate(title), *row)))]:
            yield translate(title), found
    yield "", [(FINE_NOTE[0], translate(FINE_NOTE[1]))]


def keys_text(layout: str = "auto", translate: Callable[[str], str] = str) -> str:
    """Text that `--list-keys` prints; `translate` is given titles, keys and help."""
    listed = list(key_groups(resolve_layout(layout), translate=translate))
    width = max(len(keys) for _, rows in listed for keys, _ in rows)
    texts = ("\n".join(f"  {keys:{width}}  {help}" for keys, help in rows) for _, rows in listed)
    return "\n\n".join(f"{title}\n{text}" if title else text for (title, _), text in zip(listed, texts, strict=True))


def chords_of(binding: Binding, layout: str) -> list[Chord]:
    plain = [parse_chord(spelling) for spelling in binding.spellings(layout)]
    return [*plain, *((code, modifiers | Modifier.SHIFT) for code, modifiers in plain if binding.held)]


class Keymap:
    """The table of bindings, indexed by chord."""

    def __init__(self, layout: str = "qwerty", letter_at: Callable[[str], str] = lambda _: "") -> None:
        self._wanted = layout
        self.layout = ""
        self.follow(letter_at)

    def follow(self, letter_at: Callable[[str], str]) -> None:
        """Take the layout that the keyboard has now, if none was asked for: its user may have switched to another."""
        layout = resolve_layout(self._wanted, letter_at)
        if layout != self.layout:
            self.layout = layout
            self._bindings = {each: binding for binding in BINDINGS for each in chords_of(binding, layout)}

    def find(self, code: int | str, modifiers: Modifier = Modifier.NONE) -> Binding | None:
        """Return the binding of a key, button or typed character with these modifiers, or None."""
        if code == Key.ESCAPE:
            modifiers = Modifier.NONE  # with any modifiers
        if Modifier.ACCEL in modifiers and code in PRINTED.values():
            modifiers &= ~Modifier.SHIFT  # some keyboards print the symbol only with Shift
        if modifiers & ~SIGNIFICANT:
            return None
        # Equal integers are one dictionary key, whatever their enumeration; codes of buttons and keys do not overlap.
        return self._bindings.get((code, modifiers))

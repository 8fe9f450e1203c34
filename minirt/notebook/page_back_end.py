"""PageDisplay: one window in a page of a browser, which sends events and gets frames.

Keys have the names of browsers (https://www.w3.org/TR/uievents-key).

jupyter_rfb, a package for this, was tried in JupyterLab (version 1.0.2) and is not used. It leaves Tab to the page and
Ctrl+S to the notebook, tells neither the place of a key nor the keypad from the arrows, raises an error for each
character, sends nothing that a thread draws, and knows no clipboard, full screen and end of the focus.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from math import inf
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from minirt.mlx.display import TICK, Display
from minirt.mlx.events import KEYS, Button, Event, Modifier
from minirt.mlx.window import Window

SCREEN = (3840, 2160)  # pixels: the largest window
AHEAD = 2  # frames under way that the page has not shown yet
COARSE = 80  # quality while frames follow each other: 4 ms at 960x540
FINE = 95  # quality of the last one
FULL_COLOUR = 0  # Pillow's number for colour at the resolution of brightness
QUIET = 0.15  # seconds after which a frame was the last one
Message = dict[str, Any]
# That of a key has what it prints or its name (`key`), its place on an American keyboard (`code`), its `location`, and
# the modifiers `shift`, `ctrl`, `alt` and `command`, the Command key of a Mac.


class PageWindow(Window):
    has_overlay = False

    display: PageDisplay

    def blit(self) -> None:
        self.shown.take_changes()
        self.stale = not self.display.offer(self.shown.pixels)

    def set_fullscreen(self, on: bool) -> None:
        """Let the page fill the screen; the window keeps its size, and the page stretches its frames."""
        self.display.send({"kind": "full screen", "on": on}, b"")

    def show_pointer(self, on: bool) -> None:
        self.display.send({"kind": "pointer", "cursor": self.cursor.value if on else "none"}, b"")

    def set_cursor(self) -> None:
        self.show_pointer(True)

    def set_clipboard(self, text: str) -> None:
        super().set_clipboard(text)
        self.display.send({"kind": "copy", "text": text}, b"")


class PageDisplay(Display):
    """A back end whose loop runs in a thread of its own. It keeps account of the frames that the page has shown.

    send: sends a message, and bytes with it, to the page.
    """

    window_type = PageWindow

    def __init__(self, send: Callable[[Message, bytes], object]) -> None:
        super().__init__()
        self.send = send
        self._sent = self._shown = 0  # numbers of the last frame that was sent, and of the last that the page has shown
        self._due = inf  # when the frame in the page is replaced by a finer one

    def run(self) -> None:
        """Take turns until the loop ends: after events, and each TICK seconds while the program is busy.

        Between turns the last frame is sent again in finer quality when that is due.
        """
        next_tick = 0.0
        self.turn(tick=False)
        while not self.over:
            has_to_tick = self.busy or self.is_to_sharpen
            self.awake.wait(max(0.0, next_tick - self.time()) if has_to_tick else None)
            self.awake.clear()
            self.perform_actions()
            is_tick = self.time() >= next_tick
            if is_tick:
                next_tick = self.time() + TICK
            self.turn(tick=is_tick and self.busy)
            for window in self.windows:
                self.sharpen(window.shown.pixels)

    def screen_size(self) -> tuple[int, int]:
        return SCREEN

    def restart(self) -> None:
        """Send the frame again, and forget those under way: another page shows the window."""
        self._shown = self._sent
        for window in self.windows:
            window.stale = True

    def acknowledge(self, number: int) -> None:
        """Note that the page has shown a frame."""
        self._shown = max(self._shown, number)

    def offer(self, pixels: NDArray[np.uint8]) -> bool:
        """Send a frame, (h, w, 4) BGRA, unless too many are under way; return whether it was sent."""
        if self._sent - self._shown >= AHEAD:
            return False
        self._send_frame(encode(pixels, COARSE))
        self._due = self.time() + QUIET
        return True

    @property
    def is_to_sharpen(self) -> bool:
        """Whether the page shows the last frame, which is a coarse one."""
        return self._due < inf and self._sent == self._shown

    def sharpen(self, pixels: NDArray[np.uint8]) -> None:
        """Send the same frame in finer quality, if no other one has followed it for some time."""
        if self.is_to_sharpen and self.time() >= self._due:
            self._due = inf
            self._send_frame(encode(pixels, FINE))

    def _send_frame(self, data: bytes) -> None:
        self._sent += 1
        self.send({"kind": "frame", "number": self._sent}, data)


def encode(pixels: NDArray[np.uint8], quality: int) -> bytes:
    """Return a frame as JPEG."""
    from PIL import Image

    height, width = pixels.shape[:2]
    picture = Image.frombuffer("RGB", (width, height), np.ascontiguousarray(pixels), "raw", "BGRX", 0, 1)
    buffer = io.BytesIO()
    options = {"subsampling": FULL_COLOUR} if quality >= FINE else {}
    picture.save(buffer, "JPEG", quality=quality, **options)
    return buffer.getvalue()


BUTTONS = (Button.LEFT, Button.MIDDLE, Button.RIGHT, Button.BACK, Button.FORWARD)  # by their numbers in JavaScript


def deliver(window: Window, message: Message, now: float) -> None:
    """Report an event of the page to the window, at the time `now` in seconds.

    Keys without a code, unknown buttons and events of an unknown kind are ignored.
    """
    point = 0, 0
    if "x" in message:  # an event of the pointer: x and y are shares of width and height
        window.keyboard.modifiers = modifiers_of(message)
        point = int(message["x"] * window.width), int(message["y"] * window.height)
    match message.get("kind"):
        case "key down":
            if code := code_of(message):
                window.keyboard.press(code, now, modifiers_of(message))
            if text := text_of(message):
                window.on_text(text)
        case "key up":
            if code := code_of(message):
                window.keyboard.release(code, modifiers_of(message))
        case "button down" | "button up":
            event = Event.BUTTON_PRESS if message["kind"] == "button down" else Event.BUTTON_RELEASE
            if 0 <= message["button"] < len(BUTTONS):
                window.on_button(event, BUTTONS[message["button"]], *point)
        case "motion":
            window.on_motion(*point)
        case "wheel":
            window.on_scroll(int(message["right"]), int(message["up"]), *point)
        case "enter" | "leave":
            window.deliver(Event.ENTER_NOTIFY if message["kind"] == "enter" else Event.LEAVE_NOTIFY)
        case "focus" | "blur":
            window.on_focus(message["kind"] == "focus")


KEYPAD: Final = 3  # the location of keys on the keypad
# Command is the modifier of shortcuts, wherever the kernel runs.
MODIFIERS: Final = {"shift": Modifier.SHIFT, "ctrl": Modifier.CTRL, "alt": Modifier.ALT, "command": Modifier.ACCEL}


def code_of(event: Message) -> int | None:
    """Return the code of the symbol that a key prints, lower case for letters; None for a key without a code.

    A key that prints no Latin letter stands for the letter that American keyboards have in its place.
    """
    key: str = event["key"]
    code: str = event["code"]
    sided_name = code.replace("Left", "L").replace("Right", "R")  # ShiftL for ShiftLeft, as in KEYS
    if sided_name != code and sided_name in KEYS:
        return KEYS[sided_name]
    if len(key) != 1:  # a name, such as ArrowUp
        name = key.removeprefix("Arrow")
        usual = KEYS.get("Return" if name == "Enter" else name)
        return KEYS.get(f"Keypad{name}", usual) if event["location"] == KEYPAD else usual
    american = code.removeprefix("Key")
    if not key.isascii() and american != code and len(american) == 1:
        return ord(american.lower())
    return ord(key.lower())


def modifiers_of(event: Message) -> Modifier:
    return Modifier(sum({modifier for name, modifier in MODIFIERS.items() if event[name]}))


def text_of(event: Message) -> str:
    """Return the text that a key types, an empty string for none. AltGr, which types symbols, is Ctrl and Alt."""
    is_shortcut = event["command"] or event["ctrl"] != event["alt"]
    key: str = event["key"]
    return key if len(key) == 1 and not is_shortcut else ""

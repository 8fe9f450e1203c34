"""One window of pyglet: its events in MiniLibX's terms, its canvas on the screen."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pyglet.window
from pyglet.window import key as pyglet_key
from pyglet.window import mouse as pyglet_mouse

from minirt.mlx.events import Button, Event
from minirt.mlx.keys import Key, Modifier
from minirt.mlx.on_pyglet.dropping import mend
from minirt.mlx.on_pyglet.picture import Picture

if TYPE_CHECKING:
    from collections.abc import Callable

    from minirt.mlx.handles import Window

BUTTONS = {
    pyglet_mouse.LEFT: Button.LEFT,
    pyglet_mouse.MIDDLE: Button.MIDDLE,
    pyglet_mouse.RIGHT: Button.RIGHT,
    pyglet_mouse.MOUSE4: Button.BACK,
    pyglet_mouse.MOUSE5: Button.FORWARD,
}
MODIFIERS = {
    pyglet_key.MOD_SHIFT: Modifier.SHIFT,
    pyglet_key.MOD_CTRL: Modifier.CTRL,
    pyglet_key.MOD_ALT: Modifier.ALT,
    pyglet_key.MOD_OPTION: Modifier.ALT,
    pyglet_key.MOD_COMMAND: Modifier.COMMAND,
}
SYMBOLS = {
    pyglet_key.LOPTION: Key.ALT_L,
    pyglet_key.ROPTION: Key.ALT_R,
    # With Shift, X11 calls Tab by another symbol, which pyglet does not know: it gives the key's code on the board.
    pyglet_key.user_key(23): Key.TAB,
}


class NativeWindow:
    """`changed` is called after every event: a turn of the loop has to follow. Its handlers return True where
    pyglet has a default of its own: Escape and the close button close nothing here."""

    def __init__(self, window: Window, changed: Callable[[], None]) -> None:
        self._window = window
        self._display = window.display
        self._changed = changed
        self._wheel = [0.0, 0.0]  # parts of steps that touch pads send
        self.pyglet = pyglet.window.Window(
            window.width, window.height, caption=window.title, resizable=window.resizable,
            file_drops=True,
            vsync=False,  # a hidden window may be flipped once a second: never wait for it
        )  # fmt: skip
        mend(self.pyglet)
        self.pyglet.push_handlers(self)
        self._picture = Picture()
        self.on_resize(window.width, window.height)

    def draw(self) -> None:
        """Bring the canvas to the screen."""
        self.pyglet.switch_to()
        self.on_draw()
        self.pyglet.flip()

    def set_fullscreen(self, on: bool) -> None:
        """Where pyglet makes a new window for that, the keys' releases went to the old one."""
        self.pyglet.set_fullscreen(on)
        self._forget_keys()
        self._window.keyboard.release_all()
        self.on_resize(0, 0)

    def move_pointer(self, x: int, y: int) -> None:
        width, height = self.pyglet.get_size()
        window = self._window
        self.pyglet.set_mouse_position(x * width // window.width, height - y * height // window.height)

    # --- pyglet's events, under its names ---

    def on_draw(self) -> None:
        self._picture.draw(self._window.shown, *self._framebuffer())

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        self._display.press(self._window, SYMBOLS.get(symbol, symbol), _modifiers(modifiers))
        self._changed()
        return True

    def on_key_release(self, symbol: int, modifiers: int) -> bool:
        released = self._window.keyboard.release(SYMBOLS.get(symbol, symbol), _modifiers(modifiers))
        self._forget_keys(released)
        self._changed()
        return True

    def on_text(self, text: str) -> None:
        self._display.text(self._window, text)
        self._changed()

    def on_mouse_press(self, x: float, y: float, button: int, modifiers: int) -> None:
        self._button(Event.BUTTON_PRESS, x, y, button, modifiers)

    def on_mouse_release(self, x: float, y: float, button: int, modifiers: int) -> None:
        self._button(Event.BUTTON_RELEASE, x, y, button, modifiers)

    def on_mouse_motion(self, x: float, y: float, _dx: float, _dy: float) -> None:
        self._display.motion(self._window, *self._from_top(x, y))
        self._changed()

    def on_mouse_drag(self, x: float, y: float, dx: float, dy: float, _buttons: int, modifiers: int) -> None:
        self._window.keyboard.modifiers = _modifiers(modifiers)
        self.on_mouse_motion(x, y, dx, dy)

    def on_mouse_scroll(self, x: float, y: float, right: float, up: float) -> None:
        self._wheel = [self._wheel[0] + right, self._wheel[1] + up]
        steps = [int(amount) for amount in self._wheel]
        self._wheel = [amount - step for amount, step in zip(self._wheel, steps, strict=True)]
        self._display.scroll(self._window, steps[0], steps[1], *self._from_top(x, y))
        self._changed()

    def on_file_drop(self, _x: int, _y: int, paths: list[str]) -> None:
        self._display.drop(self._window, paths)
        self._changed()

    def on_mouse_enter(self, x: float, y: float) -> None:
        self._display.move(self._window, *self._from_top(x, y))
        self._window.deliver(Event.ENTER_NOTIFY)
        self._changed()

    def on_mouse_leave(self, _x: float, _y: float) -> None:
        self._window.deliver(Event.LEAVE_NOTIFY)
        self._changed()

    def on_activate(self) -> None:
        self._display.focus(self._window, True)
        self._changed()

    def on_deactivate(self) -> None:
        self._forget_keys()
        self._display.focus(self._window, False)
        self._changed()

    def on_expose(self) -> None:
        if self._window.announced:
            self._display.expose(self._window)
        self._changed()

    def on_show(self) -> None:
        self._display.set_visible(self._window, True)
        self._changed()

    def on_hide(self) -> None:
        self._display.set_visible(self._window, False)
        self._changed()

    def on_resize(self, _width: int, _height: int) -> None:
        self._window.scale = self._scale()
        self._display.resize(self._window, *self._framebuffer())
        self._changed()
        if sys.platform in ("win32", "darwin") and self._window.announced:
            self.draw()  # the loop stands still there while a border is dragged

    def on_scale(self, _scale: float, _dpi: int) -> None:
        self.on_resize(0, 0)

    def on_close(self) -> bool:
        self._display.close_button(self._window)
        self._changed()
        return True

    def _button(self, event: Event, x: float, y: float, button: int, modifiers: int) -> None:
        self._window.keyboard.modifiers = _modifiers(modifiers)
        if button in BUTTONS:
            self._display.button(self._window, event, BUTTONS[button], *self._from_top(x, y))
        self._changed()

    def _from_top(self, x: float, y: float) -> tuple[int, int]:
        """pyglet counts from the bottom, in units that need not be pixels."""
        width, height = self.pyglet.get_size()
        window = self._window
        return int(x * window.width / width), window.height - 1 - int(y * window.height / height)

    def _framebuffer(self) -> tuple[int, int]:
        width, height = self.pyglet.get_framebuffer_size()
        return max(int(width), 1), max(int(height), 1)

    def _scale(self) -> float:
        """Where the platform counts in units that are larger than pixels, or says how fine its screen is."""
        finer = self.pyglet.get_framebuffer_size()[0] / self.pyglet.get_size()[0]
        return max(1.0, float(finer), float(self.pyglet.scale))

    def _forget_keys(self, keys: list[int] | None = None) -> None:
        """On X11 pyglet swallows the press of a key whose release it never saw."""
        pressed: set[int] = getattr(self.pyglet, "pressed_keys", set())
        pressed.difference_update(set(pressed) if keys is None else keys)


def _modifiers(flags: int) -> Modifier:
    modifiers = Modifier.NONE
    for flag, modifier in MODIFIERS.items():
        if flags & flag:
            modifiers |= modifier
    return modifiers

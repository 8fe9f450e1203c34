"""NativeWindow: a pyglet window, which translates events to MiniLibX's terms and shows a canvas."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from pyglet.window import key as pyglet_key
from pyglet.window import mouse as pyglet_mouse

from minirt.mlx.events import Button, Event, Key, Modifier
from minirt.mlx.on_pyglet.pyglet_window import CanvasTexture, PygletWindow
from minirt.mlx.on_pyglet.x11 import (
    KeyEvent,
    fix_drag_enter,
    manager_has_full_screen,
    report_key_events,
    request_full_screen,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from minirt.mlx.window import Window

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
    # X11 has another symbol for Shift+Tab, which pyglet does not know: pyglet reports the scan code instead.
    pyglet_key.user_key(23): Key.TAB,
}


class NativeWindow:
    """A pyglet window. `clock` gives seconds; `changed` is called after every event, since a turn of the loop has to
    follow. Handlers return True to suppress pyglet's defaults: Escape and the close button close nothing here."""

    def __init__(self, window: Window, clock: Callable[[], float], changed: Callable[[], None]) -> None:
        self._window = window
        self._clock = clock
        self._changed = changed
        self._wheel = [0.0, 0.0]  # fractions of steps, which touch pads send
        self.pyglet = PygletWindow(
            window.display.options.application,
            window.width, window.height, caption=window.title, resizable=window.resizable,
            file_drops=True,
            vsync=False,  # a buffer swap of a hidden window may take a second: never wait for it
        )  # fmt: skip
        fix_drag_enter(self.pyglet)
        self._is_reported = False  # the key event that pyglet handles now
        report_key_events(self.pyglet, self._on_key_event)
        self.pyglet.push_handlers(self)
        self._texture = CanvasTexture()
        self.on_resize(window.width, window.height)

    def draw(self) -> None:
        """Blit the canvas to the frame buffer and swap."""
        self.pyglet.switch_to()
        self.on_draw()
        self.pyglet.flip()

    def set_fullscreen(self, on: bool) -> None:
        """Enter or leave full screen: the window manager changes the size of the window, which stays the same one.

        Without such a window manager, and for windows of fixed size, pyglet may replace the window. Then all keys are
        released, because the new one gets no releases.
        """
        if self._window.resizable and not self.pyglet.fullscreen and manager_has_full_screen(self.pyglet):
            request_full_screen(self.pyglet, on)
            return
        self.pyglet.set_fullscreen(on)
        self.pyglet.set_icons(self._window.icons)
        self._forget_keys()
        self._window.keyboard.release_all()
        self.on_resize(0, 0)

    def move_pointer(self, x: int, y: int) -> None:
        """Move the pointer to a pixel of the window, counted from the top left corner."""
        width, height = self.pyglet.get_size()
        window = self._window
        self.pyglet.set_mouse_position(x * width // window.width, height - y * height // window.height)

    # --- pyglet's events, under its names ---

    def on_draw(self) -> None:
        self._texture.draw(self._window.shown, *self._framebuffer_size())

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        if not self._is_reported:
            self._window.keyboard.press(SYMBOLS.get(symbol, symbol), self._clock(), _modifiers(modifiers))
            self._changed()
        return True

    def on_key_release(self, symbol: int, modifiers: int) -> bool:
        if not self._is_reported:
            released = self._window.keyboard.release(SYMBOLS.get(symbol, symbol), _modifiers(modifiers))
            self._forget_keys(released)
            self._changed()
        return True

    def on_text(self, text: str) -> None:
        self._window.on_text(text)
        self._changed()

    def on_mouse_press(self, x: float, y: float, button: int, modifiers: int) -> None:
        self._button(Event.BUTTON_PRESS, x, y, button, modifiers)

    def on_mouse_release(self, x: float, y: float, button: int, modifiers: int) -> None:
        self._button(Event.BUTTON_RELEASE, x, y, button, modifiers)

    def on_mouse_motion(self, x: float, y: float, _dx: float, _dy: float) -> None:
        self._window.on_motion(*self._from_top(x, y))
        self._changed()

    def on_mouse_drag(self, x: float, y: float, dx: float, dy: float, _buttons: int, modifiers: int) -> None:
        self._window.keyboard.modifiers = _modifiers(modifiers)
        self.on_mouse_motion(x, y, dx, dy)

    def on_mouse_scroll(self, x: float, y: float, right: float, up: float) -> None:
        self._wheel = [self._wheel[0] + right, self._wheel[1] + up]
        steps = [int(amount) for amount in self._wheel]
        self._wheel = [amount - step for amount, step in zip(self._wheel, steps, strict=True)]
        self._window.on_scroll(steps[0], steps[1], *self._from_top(x, y))
        self._changed()

    def on_file_drop(self, _x: int, _y: int, paths: list[str]) -> None:
        self._window.on_drop(paths)
        self._changed()

    def on_mouse_enter(self, x: float, y: float) -> None:
        self._window.place_pointer(*self._from_top(x, y))
        self._window.deliver(Event.ENTER_NOTIFY)
        self._changed()

    def on_mouse_leave(self, _x: float, _y: float) -> None:
        self._window.deliver(Event.LEAVE_NOTIFY)
        self._changed()

    def on_activate(self) -> None:
        self._window.on_focus(True)
        self._changed()

    def on_deactivate(self) -> None:
        self._forget_keys()
        self._window.on_focus(False)
        self._changed()

    def on_expose(self) -> None:
        if self._window.announced:
            self._window.on_expose()
        self._changed()

    def on_show(self) -> None:
        self._window.on_visibility(True)
        self._changed()

    def on_hide(self) -> None:
        self._window.on_visibility(False)
        self._changed()

    def on_resize(self, _width: int, _height: int) -> None:
        self._window.scale = self._scale()
        self._window.on_resize(*self._framebuffer_size())
        self._changed()
        if sys.platform in ("win32", "darwin") and self._window.announced:
            self.draw()  # the loop stands still on these platforms while a border is dragged

    def on_scale(self, _scale: float, _dpi: int) -> None:
        self.on_resize(0, 0)

    def on_close(self) -> bool:
        self._window.on_close_button()
        self._changed()
        return True

    def _on_key_event(self, event: KeyEvent | None) -> None:
        """Report a key event before pyglet handles it, if pyglet would report another key; None: it has handled it."""
        self._is_reported = False
        code = event and (event.letter if self._window.display.options.symbols else event.code)
        if event and code:
            self._is_reported = True
            keyboard = self._window.keyboard
            if event.pressed:
                keyboard.press(code, self._clock(), _modifiers(event.modifiers))
            else:
                keyboard.release(code, _modifiers(event.modifiers))
            self._changed()

    def _button(self, event: Event, x: float, y: float, button: int, modifiers: int) -> None:
        self._window.keyboard.modifiers = _modifiers(modifiers)
        if button in BUTTONS:
            self._window.on_button(event, BUTTONS[button], *self._from_top(x, y))
        self._changed()

    def _from_top(self, x: float, y: float) -> tuple[int, int]:
        """Convert from pyglet's coordinates, which start at the bottom and need not be pixels."""
        width, height = self.pyglet.get_size()
        window = self._window
        return int(x * window.width / width), window.height - 1 - int(y * window.height / height)

    def _framebuffer_size(self) -> tuple[int, int]:
        width, height = self.pyglet.get_framebuffer_size()
        return max(int(width), 1), max(int(height), 1)

    def _scale(self) -> float:
        """Scale factor of the screen: pixels per unit of the platform, or the scale that the platform reports."""
        ratio = self.pyglet.get_framebuffer_size()[0] / self.pyglet.get_size()[0]
        return max(1.0, float(ratio), float(self.pyglet.scale))

    def _forget_keys(self, keys: list[int] | None = None) -> None:
        """Clear pyglet's pressed keys: on X11 it swallows the press of a key whose release it did not see."""
        pressed: set[int] = getattr(self.pyglet, "pressed_keys", set())
        pressed.difference_update(set(pressed) if keys is None else keys)


def _modifiers(flags: int) -> Modifier:
    """Convert pyglet's modifier flags."""
    modifiers = Modifier.NONE
    for flag, modifier in MODIFIERS.items():
        if flags & flag:
            modifiers |= modifier
    return modifiers

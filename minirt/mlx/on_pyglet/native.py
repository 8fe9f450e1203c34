"""NativeWindow: a pyglet window, which translates events to MiniLibX's terms and shows a canvas."""

from __future__ import annotations

import sys
from functools import partial
from typing import Any

from pyglet.image import ImageData
from pyglet.window import key as pyglet_key
from pyglet.window import mouse as pyglet_mouse

from minirt.errors import MlxError
from minirt.mlx.display import NO_WINDOW
from minirt.mlx.events import Button, Cursor, Event, Key, Modifier
from minirt.mlx.on_pyglet import x11
from minirt.mlx.on_pyglet.pyglet_window import CanvasTexture, OverlayTriangles, PygletWindow, new_cursor
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
# X11 has another symbol for Shift+Tab, which pyglet does not know: pyglet reports the scan code instead, 23.
SYMBOLS = {pyglet_key.LOPTION: Key.ALT_L, pyglet_key.ROPTION: Key.ALT_R, pyglet_key.user_key(23): Key.TAB}


class NativeWindow(Window):
    """A pyglet window. A method with the name of an event of pyglet, such as `on_draw`, handles that event.

    After each event the loop of the display takes a turn. Handlers return True to suppress pyglet's defaults: Escape
    and the close button close nothing here.
    """

    def __post_init__(self) -> None:
        """Open the window, and connect its events to the methods here. MlxError."""
        super().__post_init__()
        self._wheel = [0.0, 0.0]  # fractions of steps, which touch pads send
        self._is_reported = False  # whether the key event that pyglet handles now was reported before
        self._triangles: OverlayTriangles | None = None  # draws the overlay; made when the overlay is first drawn
        self._cursors: dict[Cursor, Any] = {}
        try:
            self.pyglet = PygletWindow(
                self.display.request_turn,
                self.display.options.application,
                self.width, self.height, caption=self.title, resizable=self.resizable,
                file_drops=True,
                vsync=False,  # a buffer swap of a hidden window may take a second: never wait for it
            )  # fmt: skip
            x11.fix_drag_enter(self.pyglet)
            x11.report_key_events(self.pyglet, self._on_key_event)
            # Methods here that are named like an event of pyglet's handle it; other events are named below.
            # `partial`: pyglet makes weak references to methods. A window is an int, to which there can be none.
            names = set(dir(self)).intersection(PygletWindow.event_types)
            self.pyglet.push_handlers(
                **{name: partial(getattr(self, name)) for name in names},
                on_mouse_press=partial(self._button, Event.BUTTON_PRESS),
                on_mouse_release=partial(self._button, Event.BUTTON_RELEASE),
                on_mouse_leave=lambda _x, _y: self.deliver(Event.LEAVE_NOTIFY),
                on_file_drop=lambda _x, _y, paths: self.on_drop(paths),
                on_activate=partial(self.on_focus, True),
                on_show=partial(self.on_visibility, True),
                on_hide=partial(self.on_visibility, False),
                on_scale=partial(self.on_resize),
            )
            self._texture = CanvasTexture()
            self.on_resize(self.width, self.height)
        except Exception as error:  # any error of pyglet means that there is no window
            raise MlxError(f"{NO_WINDOW} with OpenGL 3.3 ({error})") from error

    # --- the contract of a back end ---

    def blit(self) -> None:
        self.pyglet.switch_to()
        self.on_draw()
        self.pyglet.flip()

    def close(self) -> None:
        self.pyglet.close()

    def set_fullscreen(self, on: bool) -> None:
        self.display.do(partial(self._set_fullscreen, on))  # not allowed inside a handler of pyglet's

    def set_title(self) -> None:
        self.pyglet.set_caption(self.title)

    def set_icons(self) -> None:
        if self.icons and x11.is_x11(self.pyglet):  # pyglet takes a tenth of a second for it
            x11.set_icon(self.pyglet, [each.pixels for each in self.icons])
        elif self.icons:
            pixels = ((each.width, each.height, "BGRA", each.pixels.tobytes(), -4 * each.width) for each in self.icons)
            self.pyglet.set_icon(*(ImageData(*each) for each in pixels))

    def set_cursor(self) -> None:
        if self.cursor not in self._cursors:
            self._cursors[self.cursor] = new_cursor(self.pyglet, self.cursor)
        self.pyglet.set_mouse_cursor(self._cursors[self.cursor])

    def show_pointer(self, on: bool) -> None:
        self.pyglet.set_mouse_visible(on)

    def move_pointer(self, x: int, y: int) -> None:
        width, height = self.pyglet.get_size()
        self.pyglet.set_mouse_position(x * width // self.width, height - y * height // self.height)

    def letter_at(self, american: str) -> str:
        return x11.letter_at(self.pyglet, american) if x11.is_x11(self.pyglet) else ""

    def get_clipboard(self) -> str:
        return str(self.pyglet.get_clipboard_text())

    def set_clipboard(self, text: str) -> None:
        self.pyglet.set_clipboard_text(text)

    # --- pyglet's events; `on_text` is that of Window ---

    def on_draw(self) -> None:
        size = self._framebuffer_size()
        self._texture.draw(self.shown, *size)
        if "overlay" in self.hooks:
            self._triangles = self._triangles or OverlayTriangles()
            self._triangles.size, self._triangles.pixels = (self.width, self.height), size
            self.display.call(self.hooks, "overlay", self._triangles)

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        if not self._is_reported:
            self.keyboard.press(SYMBOLS.get(symbol, symbol), self.display.time(), _modifiers(modifiers))
        return True

    def on_key_release(self, symbol: int, modifiers: int) -> bool:
        if not self._is_reported:
            self._forget_keys(self.keyboard.release(SYMBOLS.get(symbol, symbol), _modifiers(modifiers)))
        return True

    def on_mouse_motion(self, x: float, y: float, _dx: float, _dy: float) -> None:
        self.on_motion(*self._from_top(x, y))

    def on_mouse_drag(self, x: float, y: float, _dx: float, _dy: float, _buttons: int, modifiers: int) -> None:
        self.keyboard.modifiers = _modifiers(modifiers)
        self.on_motion(*self._from_top(x, y))

    def on_mouse_scroll(self, x: float, y: float, right: float, up: float) -> None:
        self._wheel = [self._wheel[0] + right, self._wheel[1] + up]
        steps = [int(amount) for amount in self._wheel]
        self._wheel = [amount - step for amount, step in zip(self._wheel, steps, strict=True)]
        self.on_scroll(steps[0], steps[1], *self._from_top(x, y))

    def on_mouse_enter(self, x: float, y: float) -> None:
        self.place_pointer(*self._from_top(x, y))
        self.deliver(Event.ENTER_NOTIFY)

    def on_deactivate(self) -> None:
        self._forget_keys()
        self.on_focus(False)

    def on_resize(self, _width: float, _height: float) -> None:
        ratio = self.pyglet.get_framebuffer_size()[0] / self.pyglet.get_size()[0]  # pixels per unit of the platform
        self.scale = max(1.0, float(ratio), float(self.pyglet.scale))
        super().on_resize(*self._framebuffer_size())
        if sys.platform in ("win32", "darwin") and self.announced:
            self.blit()  # the loop stands still on these platforms while a border is dragged

    def on_close(self) -> bool:
        self.on_close_button()
        return True

    def _set_fullscreen(self, on: bool) -> None:
        """Enter or leave full screen, if the window is still open; X11's window manager then only resizes it.

        Without such a window manager, and for windows of fixed size, pyglet may replace the system's window. Then all
        keys are released, because the new window gets no releases.
        """
        if not self.is_open:
            return
        if self.resizable and not self.pyglet.fullscreen and x11.request_full_screen(self.pyglet, on):
            return
        self.pyglet.set_fullscreen(on)
        self.set_icons()
        self._forget_keys()
        self.keyboard.release_all()
        self.on_resize(0, 0)  # which asks pyglet for the size, and uses no argument

    def _on_key_event(self, event: x11.KeyEvent | None) -> None:
        """Report a key event before pyglet handles it, if pyglet would report another key; None: it has handled it."""
        code = event and (event.letter if self.display.options.symbols else event.code)
        self._is_reported = bool(code)
        if event and code and event.pressed:
            self.keyboard.press(code, self.display.time(), _modifiers(event.modifiers))
        elif event and code:
            self.keyboard.release(code, _modifiers(event.modifiers))

    def _button(self, event: Event, x: float, y: float, button: int, modifiers: int) -> None:
        self.keyboard.modifiers = _modifiers(modifiers)
        if button in BUTTONS:
            self.on_button(event, BUTTONS[button], *self._from_top(x, y))

    def _from_top(self, x: float, y: float) -> tuple[int, int]:
        """Convert from pyglet's coordinates, which start at the bottom and need not be pixels."""
        width, height = self.pyglet.get_size()
        return int(x * self.width / width), self.height - 1 - int(y * self.height / height)

    def _framebuffer_size(self) -> tuple[int, int]:
        width, height = self.pyglet.get_framebuffer_size()
        return max(int(width), 1), max(int(height), 1)

    def _forget_keys(self, keys: list[int] | None = None) -> None:
        """Clear pyglet's pressed keys: on X11 it swallows the press of a key whose release it did not see."""
        pressed: set[int] = getattr(self.pyglet, "pressed_keys", set())
        pressed.difference_update(set(pressed) if keys is None else keys)


def _modifiers(flags: int) -> Modifier:
    """Convert pyglet's modifier flags."""
    return Modifier(sum({modifier for flag, modifier in MODIFIERS.items() if flags & flag}))

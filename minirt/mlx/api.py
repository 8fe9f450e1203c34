"""Mlx: MiniLibX's functions under their own names, with the arguments and results of its official Python wrapper.

    m = Mlx()
    mlx = m.mlx_init()
    win = m.mlx_new_window(mlx, 640, 480, "hello")
    m.mlx_string_put(mlx, win, 10, 10, 0xFFFFFF, "press a key")
    m.mlx_key_hook(win, lambda key, _: m.mlx_loop_exit(mlx), None)
    m.mlx_loop(mlx)

Handles, which are numbers in the wrapper, are objects here, and numbers, too: `Display`, `Window`, `MlxImage`.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from signal import SIGINT, SIGTERM

from minirt.errors import MlxError
from minirt.helpers.signals import signal_handlers
from minirt.mlx.arguments import Hook, Host, Integer, MaybeNone, MlxImage, integer, set_hook
from minirt.mlx.calls import Calls
from minirt.mlx.display import NO_WINDOW, Display
from minirt.mlx.events import Cursor, Event, Modifier
from minirt.mlx.text import draw_text
from minirt.mlx.window import Window

PITCH = 10  # pixels from one character to the next, as in the wrapper: programs centre and align text by it


class Mlx(Calls):
    """MiniLibX's functions as methods; those without a result return 0. Colours are 0xAARRGGBB; x goes right, y down.

    backend: the window system; None is the screen, `minirt.mlx.memory.Memory()` needs none.
    alpha, strict, symbols: see `minirt.mlx.arguments.Options`; the defaults are what the wrapper does.
    """

    # --- opening and closing ---

    def mlx_init(self) -> Display | MaybeNone:
        """Open the display; None if there is none."""
        try:
            display = self._mlx_backend or _pyglet_display()
            display.open(self._mlx_options)
        except MlxError as error:
            return self._mlx_failed(error)
        return display

    def mlx_release(self, mlx_ptr: Display) -> int:
        """Close all windows and the display."""
        mlx_ptr.close()
        return 0

    mlx_destroy_display = mlx_release

    def mlx_new_window(
        self, mlx_ptr: Display, width: Integer, height: Integer, title: str, *, resizable: bool = False
    ) -> Window | MaybeNone:
        """Open a window of so many pixels; None if that fails. Several may be open. A resizable window may get another
        size: see `mlx_get_window_size`."""
        columns, rows = integer(width), integer(height)
        try:
            if columns < 1 or rows < 1:
                raise MlxError(f"a window of {columns}x{rows} pixels cannot be opened")
            window = mlx_ptr.window_type(mlx_ptr, columns, rows, title, resizable)
        except MlxError as error:
            return self._mlx_failed(error)
        mlx_ptr.windows.append(window)
        window.show()
        return window

    def mlx_destroy_window(self, mlx_ptr: Display, win_ptr: Window) -> int:
        """Close a window. May be called inside any hook, and twice for the same window."""
        mlx_ptr.destroy(win_ptr)
        return 0

    # --- drawing on a window, which is shown at the end of the loop's turn; `mlx_ptr` is unused, as in MiniLibX ---

    def mlx_clear_window(self, mlx_ptr: Host, win_ptr: Window) -> int:
        """Fill the window with black."""
        win_ptr.canvas.clear()
        return 0

    def mlx_pixel_put(self, mlx_ptr: Host, win_ptr: Window, x: Integer, y: Integer, color: Integer) -> int:
        """Blend one pixel into the window. Of several at one place without other drawing between, the last counts."""
        try:
            win_ptr.canvas.point(x, y, color)
        except TypeError:  # not integers of Python: a test before would take as long as the point
            win_ptr.canvas.point(integer(x), integer(y), integer(color))
        return 0

    def mlx_string_put(
        self, mlx_ptr: Host, win_ptr: Window, x: Integer, y: Integer, color: Integer, string: str
    ) -> int:
        """Draw opaque text of 0xRRGGBB with its top left corner at x, y; a character takes 10x20 pixels."""
        canvas, left, top = win_ptr.canvas, integer(x), integer(y)
        width, height = draw_text(canvas.pixels, left, top, string, integer(color), pitch=PITCH)
        canvas.touch(left, top, left + width, top + height)
        return 0

    # --- mouse, keyboard, screen ---

    def mlx_mouse_get_pos(self, mlx_ptr: Window | Display) -> tuple[int, int, int]:
        """Return (0, x, y) of the pointer, as of the last event, in a window or the first window of a display."""
        return 0, *_window_of(mlx_ptr).pointer

    def mlx_mouse_move(self, mlx_ptr: Window | Display, x: Integer, y: Integer) -> int:
        """Move the pointer to x, y of a window or of the first window of a display."""
        window, left, top = _window_of(mlx_ptr), integer(x), integer(y)
        window.move_pointer(left, top)
        window.place_pointer(left, top)
        return 0

    def mlx_mouse_hide(self, mlx_ptr: Display) -> int:
        """Hide the pointer over all open windows."""
        for window in mlx_ptr.windows:
            window.show_pointer(False)
        return 0

    def mlx_mouse_show(self, mlx_ptr: Display) -> int:
        """Show the pointer over all open windows."""
        for window in mlx_ptr.windows:
            window.show_pointer(True)
        return 0

    def mlx_do_key_autorepeaton(self, mlx_ptr: Display) -> int:
        """Let held keys repeat, each time as a release and a press: the default. Only this program is affected."""
        mlx_ptr.autorepeat = True
        return 0

    def mlx_do_key_autorepeatoff(self, mlx_ptr: Display) -> int:
        """Report each key once, however long it is held."""
        mlx_ptr.autorepeat = False
        return 0

    def mlx_get_screen_size(self, mlx_ptr: Display) -> tuple[int, int, int]:
        """Return (0, width, height) of the screen in pixels."""
        return 0, *mlx_ptr.screen_size()

    # --- extensions that a viewer needs, named as in MLX42 where MLX42 has them ---

    def mlx_resize_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(width, height, param) once for all resizes that came together."""
        return set_hook(win_ptr.hooks, "resize", callback, param)

    def mlx_close_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) for the close button; the window stays until it is destroyed."""
        return set_hook(win_ptr.hooks, Event.DESTROY_NOTIFY, callback, param)

    def mlx_text_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(text, param) for typed text, in the keyboard's layout; repeats while a key is held."""
        return set_hook(win_ptr.hooks, "text", callback, param)

    def mlx_overlay_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(painter, param) whenever the canvas is brought to the screen, to draw triangles over it.

        `painter` is an `on_pyglet.pyglet_window.Triangles`; without a graphics card there is none, and no call.
        A vertex is x, y, u, v as float32 and RGBA as bytes, an index two bytes. Triangles of one texture are a run:
        texture, clipping rectangle (left, top, right, bottom), count of indices, first index, vertex of index 0.
        """
        win_ptr.stale = True
        return set_hook(win_ptr.hooks, "overlay", callback, param)

    def mlx_drop_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(file, param) for each file that is dropped on the window."""
        return set_hook(win_ptr.hooks, "drop", callback, param)

    def mlx_lost_hook(self, mlx_ptr: Display, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) when the connection to the screen is lost. The program ends after it, with status 1."""
        return set_hook(mlx_ptr.hooks, "lost", callback, param)

    def mlx_get_modifiers(self, win_ptr: Window) -> Modifier:
        """Return the held modifiers, as of the event that a hook is called for."""
        return win_ptr.keyboard.modifiers

    def mlx_get_window_size(self, win_ptr: Window) -> tuple[int, int, int]:
        """Return (0, width, height): the size for the next drawing call."""
        return 0, win_ptr.width, win_ptr.height

    def mlx_get_window_scale(self, win_ptr: Window) -> float:
        """Return the scale factor of the window's screen: 1.0 on a usual screen, 2.0 on many laptops."""
        return win_ptr.scale

    def mlx_set_window_title(self, win_ptr: Window, title: str) -> int:
        win_ptr.title = title
        win_ptr.set_title()
        return 0

    def mlx_set_window_icon(self, win_ptr: Window, images: Sequence[MlxImage]) -> int:
        """Set the icon of a window: the same picture in several sizes."""
        win_ptr.icons = tuple(images)
        win_ptr.set_icons()
        return 0

    def mlx_set_cursor(self, win_ptr: Window, cursor: Cursor) -> int:
        """Give the pointer a shape over the window."""
        if cursor is not win_ptr.cursor:
            win_ptr.cursor = cursor
            win_ptr.set_cursor()
        return 0

    def mlx_set_fullscreen(self, win_ptr: Window, on: bool) -> int:
        """Enter or leave full screen before the next turn; a resize follows."""
        win_ptr.set_fullscreen(on)
        return 0

    def mlx_wake(self, mlx_ptr: Display) -> int:
        """Make the loop call the wake hook soon, in its own thread. Callable from any thread; calls may be merged."""
        mlx_ptr.wake()
        return 0

    def mlx_wake_hook(self, mlx_ptr: Display, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) after `mlx_wake`."""
        return set_hook(mlx_ptr.hooks, "wake", callback, param)

    def mlx_time(self, mlx_ptr: Display) -> float:
        """Return the seconds of a clock, which is simulated without a screen."""
        return mlx_ptr.time()

    def mlx_get_clipboard(self, win_ptr: Window) -> str:
        return win_ptr.get_clipboard()

    def mlx_set_clipboard(self, win_ptr: Window, text: str) -> int:
        win_ptr.set_clipboard(text)
        return 0


def _window_of(handle: Window | Display) -> Window:
    """Return the window itself, or the first one of a display: the wrapper names the argument after the display."""
    return handle if isinstance(handle, Window) else handle.windows[0]


def _pyglet_display() -> Display:
    """Make the display of a real screen, imported only now because its import opens the display."""
    try:
        with signal_handlers(SIGINT, SIGTERM):  # which the import changes on macOS
            from minirt.mlx.on_pyglet.loop import PygletDisplay
    except Exception as error:  # any error of the window system means that there is no window
        missing = type(error).__name__ == "NoSuchDisplayException" and not os.environ.get("DISPLAY")
        reason = "there is no display" if missing else str(error) or type(error).__name__
        raise MlxError(f"{NO_WINDOW} ({reason})") from error
    return PygletDisplay()

"""Extensions of MiniLibX that a viewer needs, named as in MLX42 where MLX42 has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.arguments import bound, set_hook
from minirt.mlx.events import Event

if TYPE_CHECKING:
    from collections.abc import Sequence

    from minirt.mlx.arguments import Hook, Image
    from minirt.mlx.display import Display
    from minirt.mlx.events import Cursor, Modifier
    from minirt.mlx.window import Window


class Extensions:
    """Base class of `Mlx`. Setting a hook to None removes it; `param` is its last argument."""

    def mlx_resize_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(width, height, param) once for all resizes that came together."""
        win_ptr.resize_hook = bound(callback, param)
        return 0

    def mlx_close_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) for the close button; the window stays until it is destroyed."""
        return set_hook(win_ptr.hooks, Event.DESTROY_NOTIFY, callback, param)

    def mlx_text_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(text, param) for typed text, in the keyboard's layout; repeats while a key is held."""
        win_ptr.text_hook = bound(callback, param)
        return 0

    def mlx_drop_hook(self, win_ptr: Window, callback: Hook | None, param: object = None) -> int:
        """Call callback(file, param) for each file that is dropped on the window."""
        win_ptr.drop_hook = bound(callback, param)
        return 0

    def mlx_lost_hook(self, mlx_ptr: Display, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) when the connection to the screen is lost. The program ends after it, with status 1."""
        mlx_ptr.lost_hook = bound(callback, param)
        return 0

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
        win_ptr.display.backend.set_title(win_ptr)
        return 0

    def mlx_set_window_icon(self, win_ptr: Window, images: Sequence[Image]) -> int:
        """Set the icon of a window: the same picture in several sizes."""
        win_ptr.icons = tuple(images)
        win_ptr.display.backend.set_icons(win_ptr)
        return 0

    def mlx_set_cursor(self, win_ptr: Window, cursor: Cursor) -> int:
        """Give the pointer a shape over the window."""
        if cursor is not win_ptr.cursor:
            win_ptr.cursor = cursor
            win_ptr.display.backend.set_cursor(win_ptr)
        return 0

    def mlx_set_fullscreen(self, win_ptr: Window, on: bool) -> int:
        """Enter or leave full screen before the next turn; a resize follows."""
        win_ptr.display.backend.set_fullscreen(win_ptr, on)
        return 0

    def mlx_wake(self, mlx_ptr: Display) -> int:
        """Make the loop call the wake hook soon, in its own thread. Callable from any thread; calls may be merged."""
        mlx_ptr.wake()
        return 0

    def mlx_wake_hook(self, mlx_ptr: Display, callback: Hook | None, param: object = None) -> int:
        """Call callback(param) after `mlx_wake`."""
        mlx_ptr.wake_hook = bound(callback, param)
        return 0

    def mlx_time(self, mlx_ptr: Display) -> float:
        """Return the seconds of a clock, which is simulated without a screen."""
        return mlx_ptr.backend.time()

    def mlx_get_clipboard(self, win_ptr: Window) -> str:
        return win_ptr.display.backend.clipboard(win_ptr)

    def mlx_set_clipboard(self, win_ptr: Window, text: str) -> int:
        win_ptr.display.backend.set_clipboard(win_ptr, text)
        return 0

"""Calls of MiniLibX for hooks and the event loop."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.events import Event
from minirt.mlx.hooks import bound, set_hook
from minirt.mlx.options import integer
from minirt.mlx.window import Window

if TYPE_CHECKING:
    from minirt.mlx.display import Display
    from minirt.mlx.hooks import Hook
    from minirt.mlx.image import Image
    from minirt.mlx.options import Integer


class LoopCalls:
    """The part of `Mlx` for hooks and the loop. A hook of None removes the one that was set."""

    SYNC_IMAGE_WRITABLE = 1
    SYNC_WIN_FLUSH = 2
    SYNC_WIN_COMPLETED = 3

    def mlx_hook(self, win_ptr: Window, x_event: Integer, x_mask: Integer, callback: Hook | None, param: object) -> int:
        """Set the one hook of an event and window. `Event` lists the arguments before `param`; the mask is unused."""
        return set_hook(win_ptr.hooks, integer(x_event), callback, param)

    def mlx_key_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(keycode, param) when a key is released."""
        return set_hook(win_ptr.hooks, Event.KEY_RELEASE, callback, param)

    def mlx_mouse_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(button, x, y, param) when a button is pressed or the wheel turned."""
        return set_hook(win_ptr.hooks, Event.BUTTON_PRESS, callback, param)

    def mlx_expose_hook(self, win_ptr: Window, callback: Hook | None, param: object) -> int:
        """Call callback(param) when the window has to be drawn; its earlier content is still there."""
        return set_hook(win_ptr.hooks, Event.EXPOSE, callback, param)

    def mlx_loop_hook(self, mlx_ptr: Display, callback: Hook | None, param: object) -> int:
        """Call callback(param) about 60 times a second; with None the loop sleeps until an event."""
        mlx_ptr.loop_hook = bound(callback, param)
        return 0

    def mlx_loop(self, mlx_ptr: Display) -> int:
        """Run until `mlx_loop_exit` or until no window is left. Ctrl+C raises KeyboardInterrupt.

        The exception of a hook is printed, and the loop goes on; with the option `strict` it is raised from here.
        """
        mlx_ptr.loop()
        return 0

    def mlx_loop_exit(self, mlx_ptr: Display) -> int:
        """End the loop; no hook is called after this."""
        mlx_ptr.ending = True
        return 0

    mlx_loop_end = mlx_loop_exit

    def mlx_do_sync(self, mlx_ptr: Display) -> int:
        """Show all windows as they are drawn now."""
        for window in mlx_ptr.windows:
            mlx_ptr.show(window)
        return 0

    def mlx_sync(self, mlx_ptr: Display, cmd: Integer, img_or_win_ptr: Image | Window) -> int:
        """Show a window now, or later if it is hidden. `cmd` is one of SYNC_…; images are always writable."""
        if isinstance(img_or_win_ptr, Window) and img_or_win_ptr.is_open and img_or_win_ptr.visible:
            mlx_ptr.show(img_or_win_ptr)
        return 0

"""Extensions of MiniLibX that a viewer needs, named as in MLX42 where MLX42 has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.events import Event

if TYPE_CHECKING:
    from minirt.mlx.display import Display
    from minirt.mlx.hooks import Hook
    from minirt.mlx.keys import Modifier
    from minirt.mlx.window import Window


class Extensions:
    """Base class of `Mlx`. Setting a hook to None removes it; `param` is its last argument."""

    def mlx_hook(self, win: Window, x_event: int, x_mask: int, f: Hook | None, param: object) -> int:
        """Set the one hook of an event and window; None removes it. `Event` lists the arguments before `param`."""
        if f is None:
            win.hooks.pop(x_event, None)
        else:
            win.hooks[x_event] = (f, param)
        return 0

    def mlx_resize_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """Call f(width, height, param) once for all resizes that came together."""
        win.resize_hook = None if f is None else (f, param)
        return 0

    def mlx_close_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """Call f(param) for the close button; the window stays until it is destroyed."""
        return self.mlx_hook(win, Event.DESTROY_NOTIFY, 0, f, param)

    def mlx_text_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """Call f(text, param) for typed text, in the keyboard's layout; repeats while a key is held."""
        win.text_hook = None if f is None else (f, param)
        return 0

    def mlx_drop_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """Call f(file, param) for each file that is dropped on the window."""
        win.drop_hook = None if f is None else (f, param)
        return 0

    def mlx_lost_hook(self, mlx: Display, f: Hook | None, param: object = None) -> int:
        """Call f(param) when the connection to the screen is lost. The program ends after it, with exit status 1."""
        mlx.lost_hook = None if f is None else (f, param)
        return 0

    def mlx_get_modifiers(self, win: Window) -> Modifier:
        """Return the held modifiers, as of the event that a hook is called for."""
        return win.keyboard.modifiers

    def mlx_get_window_size(self, win: Window) -> tuple[int, int, int]:
        """Return (0, width, height): the size for the next drawing call."""
        return 0, win.width, win.height

    def mlx_get_window_scale(self, win: Window) -> float:
        """Return the scale factor of the window's screen: 1.0 on a usual screen, 2.0 on many laptops."""
        return win.scale

    def mlx_set_window_title(self, win: Window, title: str) -> int:
        win.title = title
        win.display.backend.set_title(win)
        return 0

    def mlx_set_fullscreen(self, win: Window, on: bool) -> int:
        """Enter or leave full screen before the next turn; a resize follows."""
        win.display.backend.set_fullscreen(win, on)
        return 0

    def mlx_wake(self, mlx: Display) -> int:
        """Make the loop call the wake hook soon, in its own thread. Callable from any thread; calls may be merged."""
        mlx.wake()
        return 0

    def mlx_wake_hook(self, mlx: Display, f: Hook | None, param: object = None) -> int:
        """Call f(param) after `mlx_wake`."""
        mlx.wake_hook = None if f is None else (f, param)
        return 0

    def mlx_time(self, mlx: Display) -> float:
        """Return the seconds of a clock, which is simulated without a screen."""
        return mlx.backend.time()

    def mlx_get_clipboard(self, win: Window) -> str:
        return win.display.backend.clipboard(win)

    def mlx_set_clipboard(self, win: Window, text: str) -> int:
        win.display.backend.set_clipboard(win, text)
        return 0

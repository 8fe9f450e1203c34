"""What MiniLibX does not have and a viewer needs, named as in MLX42 where that has it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from minirt.mlx.events import Event

if TYPE_CHECKING:
    from minirt.mlx.display import Display
    from minirt.mlx.handles import Hook, Window
    from minirt.mlx.keys import Modifier


class Extensions:
    """Base of `Mlx`. A hook of None removes the hook; `param` is given to it last."""

    def mlx_hook(self, win: Window, x_event: int, x_mask: int, f: Hook | None, param: object) -> int:
        """One hook for each event and window; None removes it. See `Event` for what it receives before `param`."""
        if f is None:
            win.hooks.pop(x_event, None)
        else:
            win.hooks[x_event] = (f, param)
        return 0

    def mlx_resize_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """f(width, height, param), once for all the resizes that came together."""
        win.resize_hook = None if f is None else (f, param)
        return 0

    def mlx_close_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """f(param), for the close button; the window stays until it is destroyed."""
        return self.mlx_hook(win, Event.DESTROY_NOTIFY, 0, f, param)

    def mlx_text_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """f(text, param), for typed text, as the keyboard's layout has it; repeats while a key is held."""
        win.text_hook = None if f is None else (f, param)
        return 0

    def mlx_drop_hook(self, win: Window, f: Hook | None, param: object = None) -> int:
        """f(file, param), for each file that is dropped on the window."""
        win.drop_hook = None if f is None else (f, param)
        return 0

    def mlx_get_modifiers(self, win: Window) -> Modifier:
        """Which modifiers are held, as of the event that a hook is called for."""
        return win.keyboard.modifiers

    def mlx_get_window_size(self, win: Window) -> tuple[int, int, int]:
        """(0, width, height): the size that the next drawing call draws on."""
        return 0, win.width, win.height

    def mlx_get_window_scale(self, win: Window) -> float:
        """How many pixels are as wide as one of a usual screen: 2.0 on many a laptop."""
        return win.scale

    def mlx_set_window_title(self, win: Window, title: str) -> int:
        win.title = title
        win.display.backend.set_title(win)
        return 0

    def mlx_set_fullscreen(self, win: Window, on: bool) -> int:
        """Cover the screen, or go back; happens before the next turn, and a resize follows."""
        win.display.backend.set_fullscreen(win, on)
        return 0

    def mlx_wake(self, mlx: Display) -> int:
        """From any thread: make the loop call the wake hook, soon, in its own thread. Calls may be merged."""
        mlx.wake()
        return 0

    def mlx_wake_hook(self, mlx: Display, f: Hook | None, param: object = None) -> int:
        """f(param), after `mlx_wake`."""
        mlx.wake_hook = None if f is None else (f, param)
        return 0

    def mlx_time(self, mlx: Display) -> float:
        """Seconds from some moment on; simulated ones without a screen."""
        return mlx.backend.time()

    def mlx_get_clipboard(self, win: Window) -> str:
        return win.display.backend.clipboard(win)

    def mlx_set_clipboard(self, win: Window, text: str) -> int:
        win.display.backend.set_clipboard(win, text)
        return 0

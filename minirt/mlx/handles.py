"""What MiniLibX's functions hand out and take back: windows and images."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from minirt.mlx.canvas import Canvas
from minirt.mlx.events import Event
from minirt.mlx.keyboard import Keyboard

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from minirt.mlx.display import Display

Hook: TypeAlias = Callable[..., object]  # its last argument is the parameter given with it
Bound: TypeAlias = tuple[Hook, object]  # a hook and its parameter


@dataclass(eq=False)
class Image:
    """A picture to draw into: (h, w, 4) uint8, in memory blue, green, red, alpha."""

    pixels: NDArray[np.uint8]

    @property
    def width(self) -> int:
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        return int(self.pixels.shape[0])


@dataclass(eq=False)
class Window:
    """An open window. A resizable one has the size of its framebuffer.

    One that is not keeps the size that was asked for: if the platform shows it larger, its picture is stretched
    and mouse positions are brought back to that size.
    """

    display: Display
    width: int  # the size of the surface for the next drawing call; the canvas follows then
    height: int
    title: str
    resizable: bool
    hooks: dict[int, Bound] = field(default_factory=dict)
    text_hook: Bound | None = None
    resize_hook: Bound | None = None
    drop_hook: Bound | None = None
    is_open: bool = True
    pointer: tuple[int, int] = (0, 0)
    scale: float = 1.0  # of its screen: 2 where dots are half as large as usual

    # Between the window and its back end:
    visible: bool = True
    stale: bool = True  # the screen does not show the canvas any more
    resized: bool = False  # and the program was not told yet
    announced: bool = False  # the program was told that the window is there

    def __post_init__(self) -> None:
        self._canvas = Canvas(self.width, self.height)
        self.keyboard = Keyboard(self.deliver)

    @property
    def shown(self) -> Canvas:
        """The canvas as it was last drawn on; after a resize it keeps its old size and is shown stretched."""
        return self._canvas

    @property
    def canvas(self) -> Canvas:
        """The canvas to draw on: of the window's size, black where it is new."""
        if (self._canvas.width, self._canvas.height) != (self.width, self.height):
            self._canvas = Canvas(self.width, self.height)
        return self._canvas

    def deliver(self, event: Event, *arguments: int) -> None:
        """Call the hook on `event`, if there is one."""
        if self.is_open:
            self.display.call(self.hooks.get(event), *arguments)

"""Screen: compose picture, marks and text into a frame and bring it to the window."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.viewer.display.help_pages import draw_help, help_pages
from minirt.viewer.display.marks import Marks
from minirt.viewer.display.overlay import HudLevel, Panel, draw_hud, draw_message, draw_panel, overlay_scale, text_size
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import State


class Screen:
    """The frame of a window, and the settings of what is drawn over the picture."""

    def __init__(self, mlx: Mlx, window: Window, layout: str) -> None:
        self.mlx = mlx
        self.window = window
        self.layout = layout  # of the keyboard, for the help
        self.level = HudLevel.LINE
        self.help = 0  # its page in the window, counted from 1
        self.text_scale = 1.0  # a factor of the user's
        self.banner = ""  # a message that stays until its reason is gone
        self.panel: Panel | None = None  # a value that is typed, or a list to choose from
        self.marks = Marks()
        self.image = mlx.mlx_new_image(window.display, 1, 1)
        self._drawn: tuple[object, ...] = ()  # the contents of the window

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    @property
    def scale(self) -> float:
        """The scale of text and icons, 1 in a usual window."""
        return overlay_scale(self.window.width, self.window.height, self.window.scale, self.text_scale)

    @property
    def text_size(self) -> int:
        """The size of text, in pixels."""
        return text_size(self.window.width, self.window.height, self.scale)

    def turn_help_page(self) -> None:
        """Show the first page of the help, the next one, or after the last one the picture."""
        pages = help_pages(self.layout, self.window.width, self.window.height, self.text_size).pages
        self.help = self.help + 1 if self.help < len(pages) else 0

    def draw(self, state: State, picture: Outcome | None, rate: float = 0.0) -> bool:
        """Draw a frame unless the window already shows it; return whether it was drawn.

        The words describe `state`, whose scene may be newer than the picture's; the marks fit the picture. `rate`:
        primary rays per second.
        """
        width, height, scale, size = self.window.width, self.window.height, self.scale, self.text_size
        message = state.message or self.banner
        described = state if self.level and not self.help else None
        contents = (
            described,
            picture,
            message,
            self.panel,
            self.level,
            self.help,
            self.marks.icons,
            width,
            height,
            scale,
        )
        if contents == self._drawn:
            return False
        self._drawn = contents
        self.image = Image(self.picture_alone(picture))
        bottom = 0
        if self.help:
            draw_help(self.frame, self.layout, size, self.help)
        elif self.level:
            if picture and (picture.job.width, picture.job.height) == (width, height):  # not an old one, stretched
                self.marks.draw(self.frame, state, picture.job.scene, scale, moving=picture.job.urgent)
            bottom = draw_hud(self.frame, state, picture, self.level, rate, size)
        if self.panel and not self.help:
            draw_panel(self.frame, self.panel, size)
        draw_message(self.frame, message, bottom, size)
        self.mlx.mlx_put_image_to_window(self.window.display, self.window, self.image, 0, 0)
        return True

    def picture_alone(self, picture: Outcome | None) -> Pixels:
        """Return a copy of the picture without overlay, stretched to the window; black if there is no picture yet."""
        width, height = self.window.width, self.window.height
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)


M_ARENA_MAX = -8  # the parameter of `mallopt` for the number of heaps


def use_one_heap() -> None:
    """Let all threads allocate from one heap, all of which can be given back. Call it before threads start."""
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1)


def give_back_memory() -> None:
    """Give the unused pages of the heap back to the system, which takes some milliseconds.

    The frames of a large window return to glibc's heap, between smaller blocks that stay. Without this a window that
    was full screen (2560x1600) once, and is small again, keeps 70 to 110 MB that nothing uses.
    """
    with suppress(OSError, AttributeError):
        if sys.platform == "linux":
            ctypes.CDLL(None).malloc_trim(ctypes.c_size_t(0))

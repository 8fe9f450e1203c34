"""Screen: compose picture, marks and text, or a page of the help, into a frame, and bring it to the window."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.viewer.display import overlay
from minirt.viewer.display.help import draw_help, help_pages
from minirt.viewer.display.marks import draw_marks
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, HudLevel, Panel, wrap
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import State
from minirt.viewer.language import translated

TAB_PARTS = 48  # of the width: a third of the tab of the panel in a narrow window
# Shown until the first edit; the keys are the same on all keyboards.
TIPS = """drag an object to move it, or nothing to look around
N adds an object where the pointer is
F1: panel    H: all keys    Ctrl+S: save"""


class Screen:
    """The frame of a window, and the settings of what is drawn over the picture."""

    def __init__(self, mlx: Mlx, window: Window, layout: str) -> None:
        self.mlx = mlx
        self.window = window
        self.layout = layout  # of the keyboard, for the help
        self.level = HudLevel.LINE
        self.help = 0  # its page in the window, counted from 1
        self.search = ""  # the letters that the rows of the help contain
        self.tips = False  # whether help for the first minute is shown
        self.text_scale = 1.0  # a factor of the user's
        self.banner = ""  # a message that stays until its reason is gone
        self.panel: Panel | None = None  # a value that is typed, or a list to choose from
        self.handles = False  # whether those of the selected element are shown
        self.has_tab = False  # whether the tab of the panel is shown, since the pointer is near
        self.icons = False  # whether the icons of all lights are shown
        self.image = mlx.mlx_new_image(window.display, 1, 1)
        self._drawn: tuple[object, ...] = ()  # the contents of the window

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    @property
    def scale(self) -> float:
        """The scale of text and icons, 1 in a usual window."""
        return overlay.overlay_scale(self.window.width, self.window.height, self.window.scale, self.text_scale)

    @property
    def text_size(self) -> int:
        """The size of text, in pixels."""
        return overlay.text_size(self.window.width, self.window.height, self.scale)

    def turn_help(self, step: int) -> None:
        """Turn the pages of the help; a step of 0 opens or closes it."""
        count = len(help_pages(self.layout, self.search, self.window.width, self.window.height, self.text_size)[1])
        self.help = min(max(self.help + step, 1), count) if step else int(not self.help)
        self.search = self.search if step else ""

    def is_on_tab(self, x: int, y: int, reach: float = 1.0) -> bool:
        """Whether a pixel is on the tab at the right edge that opens the panel, or within `reach` times its size."""
        width, height = self.window.width, self.window.height
        size = reach * min(self.text_size, width // TAB_PARTS)
        return x >= width - 3 * size and abs(y - height // 2) <= size

    def draw(self, state: State, picture: Outcome | None, rate: float = 0.0, *, keys_held: bool = False) -> bool:
        """Draw a frame unless the window already shows it; return whether it was drawn.

        The words describe `state`, whose scene may be newer than the picture's; the marks fit the picture. `rate`:
        primary rays per second; `keys_held`: handles would be in the way.
        """
        width, height, scale, size = self.window.width, self.window.height, self.scale, self.text_size
        message = state.message or self.banner
        described = state if self.level and not self.help else None
        handles = self.handles and not keys_held
        shown = self.panel, self.has_tab, self.level, self.help, self.search, self.icons, self.tips, handles
        contents = described, picture, message, *shown, width, height, scale
        if contents == self._drawn:
            return False
        self._drawn = contents
        self.image = Image(self.picture_alone(picture))
        bottom = 0
        if self.help:
            draw_help(self.frame, self.layout, self.search, size, self.help)
        elif self.level:
            if picture and (picture.job.width, picture.job.height) == (width, height):  # not an old one, stretched
                job = picture.job
                marks = {"icons": self.icons, "handles": handles}
                draw_marks(self.frame, state, job.scene, scale, moving=job.urgent, **marks)
            bottom = overlay.draw_hud(self.frame, state, picture, self.level, rate, size)
        if self.has_tab and not self.help:
            overlay.draw_tab(self.frame, size)
        if self.panel and not self.help:
            overlay.draw_panel(self.frame, self.panel, size)
        elif self.tips and self.level and not message:
            message = TIPS
        if message and not self.help:  # above the text at the bottom
            words = wrap(translated(message), width, size)
            overlay.draw_lines(self.frame, -MARGIN - bottom, words, MESSAGE_COLOUR, size)
        self.mlx.mlx_put_image_to_window(self.window.display, self.window, self.image, 0, 0)
        return True

    def picture_alone(self, picture: Outcome | None) -> Pixels:
        """Return a copy of the picture without overlay, stretched to the window; black if there is no picture yet."""
        width, height = self.window.width, self.window.height
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)


def give_back_memory() -> None:
    """Give the unused pages of the heap back to the system, which takes some milliseconds.

    The frames of a large window return to glibc's heap, between smaller blocks that stay. Without this a window that
    was full screen (2560x1600) once, and is small again, keeps 70 to 110 MB that nothing uses.
    """
    with suppress(OSError, AttributeError):  # no other library of C has it
        if sys.platform == "linux":
            ctypes.CDLL(None).malloc_trim(ctypes.c_size_t(0))

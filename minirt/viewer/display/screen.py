"""Screen: compose picture, marks and text, or a page of the help, into a frame, and bring it to the window."""

from __future__ import annotations

import ctypes
import sys
from contextlib import suppress

import numpy as np

from minirt.mlx import Mlx, MlxImage, Window
from minirt.mlx.canvas import stretch
from minirt.mlx.text import draw_text, measure
from minirt.viewer.bindings import Keymap
from minirt.viewer.display import overlay, tool_row
from minirt.viewer.display.explained import Explained, draw_explained
from minirt.viewer.display.ground import ground_lines
from minirt.viewer.display.help_pages import draw_help, help_pages
from minirt.viewer.display.jobs import Painted, Pixels
from minirt.viewer.display.lists import ListBox, draw_list
from minirt.viewer.display.marks import draw_marks
from minirt.viewer.display.overlay import MARGIN, MESSAGE_COLOUR, TEXT_COLOUR, HudLevel, wrap
from minirt.viewer.display.tool_row import Tool, draw_tools, tool_at
from minirt.viewer.editing.handles import shows_handles
from minirt.viewer.editing.state import State
from minirt.viewer.editing.values import Value
from minirt.viewer.language import translated

TAB_PARTS = 48  # of the width: a third of the tab of the panel in a narrow window
# Shown until the first edit; the keys are the same on all keyboards.
TIPS = """drag an object to move it, or nothing to look around    wheel: zoom    right drag: turn around
right click: add, copy, delete and more    L: the light
H: all keys    F1: panel, film    Ctrl+Z: undo    Ctrl+S: save    Esc: quit
click on a value in the line on top: type it"""
BEYOND = "outside of the saved picture"
GRID_COLOUR = (84, 75, 68, 255)  # BGRA
LEAST_LINES = 12  # sizes of text: in a lower window the line on top covers too much of the picture to take its clicks


class Screen:
    """The frame of a window, and the settings of what is drawn over the picture."""

    def __init__(self, mlx: Mlx, window: Window, keymap: Keymap) -> None:
        self.mlx = mlx
        self.window = window
        self.keymap = keymap  # for the help
        self.level = HudLevel.LINE
        self.help = 0  # its page in the window, counted from 1
        self.search = ""  # the letters that the rows of the help contain
        self.tips = False  # whether help for the first minute is shown
        self.text_scale = 1.0  # a factor of the user's
        self.banner = ""  # a message that stays until its reason is gone
        self.list_box: ListBox | None = None  # a value that is typed, or a list to choose from
        self.explained: Explained | None = None  # a pixel, whose rays are shown
        self.handles = False  # whether those of the selected element are shown, and the tool row
        self.handle_kind = ""  # of the handles that are shown alone
        self.tool: Tool | None = None  # the one under the pointer
        self.covered = 0  # columns at the right that the panel covers: the picture is as wide as the others
        self.has_tab = False  # whether the tab of the panel is shown, since the pointer is near
        self.icons = False  # whether the icons of all lights are shown
        self.pointed: int | None = None  # index of the element whose row in the panel's list the pointer is on
        self.image = mlx.mlx_new_image(window.display, 1, 1)
        self._drawn: tuple[object, ...] = ()  # the contents of the window

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, which lies beside the panel."""
        return max(1, self.window.width - self.covered), self.window.height

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
        count = len(help_pages(self.keymap.layout, self.search, *self.size, self.text_size)[1])
        self.help = min(max(self.help + step, 1), count) if step else int(not self.help)
        self.search = self.search if step else ""

    def is_on_tab(self, x: int, y: int, reach: float = 1.0) -> bool:
        """Whether a pixel is on the tab at the right edge that opens the panel, or within `reach` times its size."""
        width, height = self.window.width, self.window.height
        size = reach * min(self.text_size, width // TAB_PARTS)
        return x >= width - 3 * size and abs(y - height // 2) <= size

    def tool_at(self, x: int, y: int) -> Tool | None:
        """Return the tool of the tool row at a pixel, None beside it."""
        is_shown = self.handles and self.level and not self.help
        return tool_at(x, y, *self.size, self.scale) if is_shown else None

    def is_on_line(self, state: State, x: int, y: int) -> bool:
        """Whether a pixel is on the line on top."""
        is_shown = self.level == HudLevel.LINE and not self.help and self.size[1] >= LEAST_LINES * self.text_size
        return is_shown and overlay.is_on_line(x, y, state, self.size[0], self.text_size)

    def value_at(self, state: State, x: int, y: int) -> Value | None:
        """Return the value, or the part of one, that the line on top shows at a pixel, None beside the values."""
        return overlay.value_at(state, x, y, self.size[0], self.text_size)

    def shows_handles(self, state: State) -> bool:
        """Whether the handles of the selected element are shown, and can be grabbed: near the pointer, and beside no
        list or typed value, which may be about something small."""
        is_free = self.handles and self.level and not self.help and not self.list_box
        return bool(is_free) and shows_handles(state, self.window.pointer, self.size, self.scale)

    @property
    def tools_width(self) -> int:
        """Columns at the left that the tool row covers."""
        return tool_row.layout(*self.size, self.scale)[0] if self.handles and self.level else 0

    def shows_picture_at(self, x: int, y: int) -> bool:
        """Whether neither the panel nor the tool row covers the picture at a pixel."""
        return x < self.size[0] and not self.tool_at(x, y)

    def tips_that_fit(self, message: str) -> str:
        """Return the help for the first minute, or those of its lines for which a third of the window has room below a
        message."""
        width, height = self.size
        tips, above = (wrap(translated(text), width, self.text_size).split("\n") for text in (TIPS, message))
        room = height // 3 // measure(" ", self.text_size)[1] - len(above)
        return "\n".join(tips[: max(0, room)])

    def draw(self, state: State, picture: Painted | None, rate: float = 0.0, *, keys_held: bool = False) -> bool:
        """Draw a frame, and bring it to the window, unless the window already shows it; return whether it was drawn.

        The words describe `state`, whose scene may be newer than the picture's; the marks fit the picture. `rate`:
        primary rays per second, a new one alone draws no frame; `keys_held`: handles would be in the way.
        """
        scale, size = self.scale, self.text_size
        message = state.message or self.banner
        described = state if self.level and not self.help else None
        handles = not keys_held and self.shows_handles(state)
        settings = self.list_box, self.has_tab, self.level, self.help, self.search, self.icons, self.tips, self.pointed
        tools = self.explained, handles, self.handles, self.handle_kind, self.tool
        look = self.size, self.window.width, scale, self.keymap.layout
        contents = described, picture, message, *settings, *tools, *look  # all that a frame depends on
        if contents == self._drawn:
            return False
        self._drawn = contents
        self.image = MlxImage(self.beside_panel(self.picture_alone(picture)))
        bottom, clear = 0, self.frame[:, : self.size[0]]  # pixels of text at the bottom; what the panel leaves clear
        background = state.scene.background
        if not picture and background and not isinstance(background.paint, str):  # while kernels are compiled
            clear[..., :3] = background.paint[::-1]
        if self.help:
            draw_help(clear, self.keymap.layout, self.search, size, self.help)
        elif self.level:
            if picture and picture.job.size == self.size:  # not an old one, stretched
                self.draw_over(clear, state, picture, handles)
            if self.covered:
                darken_beyond(clear, self.window.width, size)
            if self.handles:
                draw_tools(clear, scale, size, self.tool, self.handle_kind, self.keymap.layout)
            bottom = overlay.draw_hud(clear, state, picture, self.level, rate, size)
        if self.has_tab and not self.help:
            overlay.draw_tab(self.frame, size)
        if self.list_box and not self.help:
            draw_list(clear, self.list_box, size)
        elif self.explained and self.level and not self.help and self.explained.fits(state.scene):
            draw_list(clear, self.explained.box(scale), size)
        elif self.tips and self.level and not self.covered:
            message = "\n".join(filter(None, (message, self.tips_that_fit(message))))
        if message and not self.help:
            self.draw_message(clear, message, bottom)
        self.mlx.mlx_put_image_to_window(self.window.display, self.window, self.image, 0, 0)
        return True

    def draw_message(self, pixels: Pixels, message: str, bottom: int) -> None:
        """Draw a message above the text at the bottom, which is `bottom` pixels high, and beside the tool row."""
        width, size = pixels.shape[1], self.text_size
        words = wrap(translated(message), width, size)
        left = tool_row.reach(*self.size, self.scale, measure(words, size)[1] + bottom) if self.handles else 0
        words = wrap(translated(message), width - left, size)
        overlay.draw_lines(pixels, -MARGIN - bottom, words, MESSAGE_COLOUR, size, left)

    def draw_over(self, pixels: Pixels, state: State, picture: Painted, handles: bool) -> None:
        """Draw what fits a picture: the ground of a scene without shapes, marks, and the rays of a pixel."""
        scene, scale, moving = picture.job.scene, self.scale, picture.job.urgent
        if not scene.runs:
            pixels[ground_lines(scene.camera, *self.size)] = GRID_COLOUR
        draw_marks(
            pixels, state, scene, scale,
            moving=moving, icons=self.icons, handles=handles, kind=self.handle_kind, pointed=self.pointed,
        )  # fmt: skip
        if self.explained:
            draw_explained(pixels, self.explained, scene, scale)

    def picture_alone(self, picture: Painted | None) -> Pixels:
        """Return a copy of the picture without overlay, stretched to `size`; black if there is no picture yet."""
        width, height = self.size
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)

    def beside_panel(self, picture: Pixels) -> Pixels:
        """Return a frame of the window's size with the picture at the left, and black under the panel."""
        if not self.covered:
            return picture
        frame = np.full((self.window.height, self.window.width, 4), (0, 0, 0, 255), np.uint8)
        frame[:, : picture.shape[1]] = picture
        return frame


def give_back_memory() -> None:
    """Give the unused pages of the heap back to the system, which takes some milliseconds.

    The frames of a large window return to glibc's heap, between smaller blocks that stay. Without this a window that
    was full screen (2560x1600) once, and is small again, keeps 70 to 110 MB that nothing uses.
    """
    with suppress(OSError, AttributeError):  # no other library of C has it
        if sys.platform == "linux":
            ctypes.CDLL(None).malloc_trim(ctypes.c_size_t(0))


def darken_beyond(pixels: Pixels, width: int, size: int) -> None:
    """Darken the rows above and below what a picture shows without the panel, which has the same height and a width.

    Where there is room the rows below say so, in text of a size.
    """
    height = pixels.shape[0]
    border = (height - height * pixels.shape[1] // width) // 2
    for rows in (slice(border), slice(height - border, None)):
        pixels[rows, :, :3] -= pixels[rows, :, :3] >> 2
    text_width, text_height = measure(words := translated(BEYOND), size)
    if text_height < border and text_width + 2 * MARGIN < pixels.shape[1]:
        draw_text(pixels, pixels.shape[1] - text_width - MARGIN, height - border, words, TEXT_COLOUR, size=size)

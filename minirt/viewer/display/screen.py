"""Screen: compose picture, marks and text into a frame and bring it to the window."""

from __future__ import annotations

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.viewer.display.marks import Marks
from minirt.viewer.display.overlay import HudLevel, draw_help, draw_hud, draw_message, text_size
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import State


class Screen:
    """The frame of a window, and the settings of what is drawn over the picture."""

    def __init__(self, mlx: Mlx, window: Window, layout: str) -> None:
        self.mlx = mlx
        self.window = window
        self.layout = layout  # of the keyboard, for the help
        self.level = HudLevel.LINE
        self.help = False
        self.banner = ""  # a message that stays until its reason is gone
        self.marks = Marks()
        self.image = mlx.mlx_new_image(window.display, 1, 1)
        self._drawn: tuple[object, ...] = ()  # the contents of the window

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    def draw(self, state: State, picture: Outcome | None, rate: float = 0.0) -> bool:
        """Draw a frame unless the window already shows it; return whether it was drawn.

        The words describe `state`, whose scene may be newer than the picture's; the marks fit the picture. `rate`:
        primary rays per second.
        """
        width, height, scale = self.window.width, self.window.height, self.window.scale
        message = state.message or self.banner
        described = state if self.level and not self.help else None
        contents = (described, picture, message, self.level, self.help, self.marks.icons, width, height, scale)
        if contents == self._drawn:
            return False
        self._drawn = contents
        self.image = Image(self.picture_alone(picture))
        size = text_size(width, height, scale)
        bottom = 0
        if self.help:
            draw_help(self.frame, self.layout, size)
        elif self.level:
            if picture and (picture.job.width, picture.job.height) == (width, height):  # not an old one, stretched
                self.marks.draw(self.frame, state, picture.job.scene, scale, moving=picture.job.urgent)
            bottom = draw_hud(self.frame, state, picture, self.level, rate, size)
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

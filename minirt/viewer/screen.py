"""The picture and what is written over it, brought to the window."""

from __future__ import annotations

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.viewer.overlay import COMPILING, draw_help, draw_hud, draw_message
from minirt.viewer.painter import Outcome, Pixels
from minirt.viewer.state import State


class Screen:
    """What a window shows over its picture, and the drawing of both."""

    def __init__(self, m: Mlx, win: Window, layout: str) -> None:
        self.m = m
        self.win = win
        self.layout = layout
        self.hud = True
        self.help = False
        self.image = m.mlx_new_image(win.display, 1, 1)
        draw_message(self.frame, COMPILING)  # the first text takes 50 ms, in which no event would be answered later
        self._drawn: tuple[object, ...] = ()  # what the window shows

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    def draw(self, state: State, picture: Outcome | None, compiling: bool) -> bool:
        """Draw all of it, unless that is what was drawn last; whether it was necessary."""
        wanted = (state, picture, compiling, self.hud, self.help, self.win.width, self.win.height)
        if wanted == self._drawn:
            return False
        self._drawn = wanted
        self.image = Image(self.bare(picture))
        if self.help:
            draw_help(self.frame, self.layout)
        elif self.hud:
            draw_hud(self.frame, state, picture)
        draw_message(self.frame, COMPILING if compiling else state.message)
        self.m.mlx_put_image_to_window(self.win.display, self.win, self.image, 0, 0)
        return True

    def bare(self, picture: Outcome | None) -> Pixels:
        """A copy of the picture alone, at the size of the window; black where there is none yet."""
        width, height = self.win.width, self.win.height
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)

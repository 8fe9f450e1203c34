"""The picture and what is written over it, brought to the window."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from minirt.mlx import Image, Mlx, Window
from minirt.mlx.canvas import stretch
from minirt.viewer.display.marks import Marks
from minirt.viewer.display.overlay import COMPILING, LETTERS, Level, draw_help, draw_hud, draw_message, letters
from minirt.viewer.display.painter import Outcome, Pixels
from minirt.viewer.editing.state import State


class Screen:
    """What a window shows over its picture, and the drawing of both."""

    def __init__(self, m: Mlx, win: Window, layout: str) -> None:
        self.m = m
        self.win = win
        self.layout = layout
        self.level = Level.LINE
        self.help = False
        self.banner = ""  # what is said for as long as it holds
        self.marks = Marks()
        self.image = m.mlx_new_image(win.display, 1, 1)
        draw_message(self.frame, COMPILING, 0, LETTERS)  # the first text takes 50 ms: now, when nobody waits
        self._drawn: tuple[object, ...] = ()  # what the window shows

    @property
    def frame(self) -> Pixels:
        """The pixels that were last brought to the window."""
        return self.image.pixels

    def draw(self, state: State, picture: Outcome | None, compiling: bool, rate: float = 0.0) -> bool:
        """Draw all of it, unless that is what was drawn last; whether it was necessary.

        `rate`: rays a second.
        """
        width, height, scale = self.win.width, self.win.height, self.win.scale
        told = COMPILING if compiling else state.message or self.banner
        wanted = (state, picture, told, self.level, self.help, self.marks.icons, width, height, scale)
        if wanted == self._drawn:
            return False
        self._drawn = wanted
        self.image = Image(self.bare(picture))
        size = letters(width, height, scale)
        taken = 0
        if self.help:
            draw_help(self.frame, self.layout, size)
        elif self.level:
            shown = in_step(state, picture)
            self.marks.draw(self.frame, shown, scale, picture is not None and picture.job.urgent)
            taken = draw_hud(self.frame, shown, picture, self.level, rate, size)
        draw_message(self.frame, told, taken, size)
        self.m.mlx_put_image_to_window(self.win.display, self.win, self.image, 0, 0)
        return True

    def bare(self, picture: Outcome | None) -> Pixels:
        """A copy of the picture alone, at the size of the window; black where there is none yet."""
        width, height = self.win.width, self.win.height
        if picture is None or picture.pixels is None:
            return np.full((height, width, 4), (0, 0, 0, 255), np.uint8)
        same_size = picture.pixels.shape[:2] == (height, width)
        return picture.pixels.copy() if same_size else stretch(picture.pixels, width, height)


def in_step(state: State, picture: Outcome | None) -> State:
    """The state with the scene of the picture, so that what is drawn over it fits to it while something moves."""
    if picture is None or picture.job.scene is state.scene:
        return state
    elements = picture.job.scene.elements
    same = state.selected < len(elements) and type(elements[state.selected]) is type(state.element)
    return replace(state, scene=picture.job.scene) if same else state

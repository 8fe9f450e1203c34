"""Headless: a run of a program by a script alone, whose last picture is saved."""

from __future__ import annotations

import sys
from pathlib import Path

from minirt.errors import MlxError, printable
from minirt.mlx.display import TICK
from minirt.mlx.memory import Memory


class Headless(Memory):
    """A user who leaves a tick of the loop between two steps, and clicks the close button at the end.

    picture: the file of the last picture, or None.
    """

    def __init__(self, picture: Path | None, screen: tuple[int, int]) -> None:
        super().__init__(screen)
        self.picture = picture

    def run(self) -> None:
        """Play the script; then save the picture, click the close button, and end the loop if that did not."""
        self.play()
        if not self.over:
            self.finish()
            self.picture = None  # what the program draws when it ends does not count
            self.window.on_close_button()
            self.turn(tick=False)

    def finish(self) -> bool:
        """Save the last picture, if one is asked for. False if that failed; the reason is printed."""
        try:
            if self.picture:
                self.save(self.picture)
        except MlxError as error:
            print(f"mlx: {printable(str(error))}", file=sys.stderr)
            return False
        return True

    def pass_time(self, seconds: float) -> None:
        """Let simulated time pass, without turns of the loop."""
        self._now += seconds

    def _settle(self) -> None:
        """Let the program handle what came, and take one tick of the loop."""
        self.turn(tick=False)
        self._advance(TICK)

"""Writer of a film that loops: a picture that stays as it is lasts longer, so that it takes no place."""

from __future__ import annotations

from collections.abc import Callable
from typing import BinaryIO

from minirt.formats.films.film import Film

Packed = Callable[[int], bytes]  # the bytes of a picture that lasts for so many units


class LoopFilm(Film):
    """A film whose last picture is not written yet: nobody knows how long it lasts."""

    longest = 0  # units that a picture can last

    def __init__(self, out: BinaryIO, fps: float, quality: int | None, each: int) -> None:
        """`each` picture lasts for so many units of the format."""
        super().__init__(out, fps, quality)
        self.each = each
        self.duration = 0  # of the last picture
        self.last: Packed | None = None

    def stays(self) -> bool:
        """Let the last picture last longer; False where it cannot."""
        if self.duration + self.each > self.longest:
            return False
        self.duration += self.each
        return True

    def follow(self, packed: Packed | None) -> None:
        """Write the last picture, which another one follows, or none."""
        if self.last:
            self.out.write(self.last(self.duration))
        self.last, self.duration = packed, self.each

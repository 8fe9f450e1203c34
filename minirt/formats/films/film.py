"""Writer of a film: the interface that the writers of all formats have."""

from __future__ import annotations

from typing import BinaryIO

import numpy as np


class Film:
    """A film that is being written to a file, which can seek: one picture after the other, all of one size."""

    def __init__(self, out: BinaryIO, fps: float, quality: int | None = None) -> None:
        """Write so many pictures a second; `quality`, from 1 to 100, is for lossy formats."""
        self.out = out
        self.fps = fps
        self.quality = quality

    def add(self, picture: np.ndarray) -> None:
        """Write a picture, (h, w, 3) uint8. OSError or ValueError when that fails."""
        raise NotImplementedError

    def end(self) -> None:
        """Write the end of a film that has pictures. OSError or ValueError when that fails."""

    def close(self) -> None:
        """Free what a film holds, whether it has its end or not."""

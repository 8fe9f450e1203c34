"""Result of rendering a picture to an error or for a time: samples, estimated error, run time."""

from __future__ import annotations

from typing import NamedTuple


class Outcome(NamedTuple):
    """How many samples a picture has, and its estimated error.

    The error is the RMSE against the converged picture, over all pixels and channels, with light clamped to [0, 1]:
    0.004 is one of 255 levels.
    """

    samples: float  # of a pixel, on average
    most: int  # of a pixel
    error: float  # estimated
    seconds: float  # run time

    def __str__(self) -> str:
        return (
            f"{self.samples:.1f} samples a pixel on average, {self.most} at most; "
            f"estimated error {self.error:.2g}; {self.seconds:.2f} s"
        )

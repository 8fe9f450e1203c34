"""What became of a picture that was to have a certain error, or to take a certain time."""

from __future__ import annotations

from typing import NamedTuple


class Outcome(NamedTuple):
    """How good a picture is.

    An error is the root of the mean square, over all pixels and colours, of the difference between the light of the
    picture and that of one with endlessly many samples, both clamped to [0, 1]: 0.004 is one of 255 levels.
    """

    samples: float  # of a pixel, on average
    most: int  # of a pixel
    error: float  # estimated
    seconds: float  # that it took

    def __str__(self) -> str:
        return (
            f"{self.samples:.1f} samples a pixel on average, {self.most} at most; "
            f"estimated error {self.error:.2g}; {self.seconds:.2f} s"
        )

"""Result of rendering a picture to an error or for a time: samples, estimated error, run time."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

ROUNDING = 1 / sqrt(12) / 255  # RMSE of rounding light to 8 bits, where all fractions of a level are as likely
ERROR_EXPONENT = 1.5  # squared error falls as this power of the number of samples
MOST_SAMPLES = 2**12  # of a pixel, by `--samples auto`


class Outcome(NamedTuple):
    """Samples and estimated error of a picture.

    The error is the RMSE against the converged picture, over all pixels and channels, with light clamped to [0, 1]:
    0.004 is one of 255 levels. It is that of light, exposure included, before a tone curve; the error of rounded levels
    is that of the light that they stand for on the curve.
    """

    samples: float  # of a pixel, on average
    most: int  # of a pixel
    error: float  # estimated, of the light before it is rounded to 8 bits
    seconds: float  # run time
    goal: float = 0.0  # the error that was asked for; 0 if none was
    rounded: bool = False  # whether rounding to 8 bits ended it
    rounding: float = ROUNDING  # RMSE of rounding, or of dithering, to 8 bits

    @property
    def error_of_bytes(self) -> float:
        """The estimated error of the picture rounded to 8 bits."""
        return sqrt(self.error**2 + self.rounding**2)

    @property
    def is_reached(self) -> bool:
        """Whether the error that was asked for was reached, if one was."""
        return not self.goal or self.error <= self.goal

    @property
    def notice(self) -> str:
        """The sentence that says that the goal was not reached, and why; empty where it was."""
        if self.rounded:
            return f"no more samples: rounding to 8 bits decides below an error of {self.rounding / 2:.2g}"
        if self.is_reached:
            return ""
        if self.most == MOST_SAMPLES:
            reason = f"some pixels have {self.most} samples, the most there are"
        else:
            reason = "the time was over"
        return f"error {self.goal:.2g} not reached: {reason}"

    def __str__(self) -> str:
        return (
            f"{self.samples:.1f} samples a pixel on average, {self.most} at most; "
            f"estimated error {self.error:.2g}, {self.error_of_bytes:.2g} when rounded to 8 bits; {self.seconds:.2f} s"
        )

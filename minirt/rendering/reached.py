"""What became of a picture that was to have a certain error, or to take a certain time."""

from __future__ import annotations

from typing import NamedTuple


class Reached(NamedTuple):
    """How good a picture is."""

    samples: float  # of a pixel, on average
    most: int  # samples of a pixel
    error: float  # estimated: root of the mean square of the differences to the picture with endlessly many samples,
    # of the light of all pixels and colours, clamped to [0, 1]
    seconds: float  # that it took

    def __str__(self) -> str:
        return (
            f"{self.samples:.1f} samples a pixel (at most {self.most}), "
            f"estimated error {self.error:.2g}, {self.seconds:.2f} s"
        )

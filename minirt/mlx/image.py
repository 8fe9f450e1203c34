"""Image: the picture in memory that MiniLibX's image functions return and take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from minirt.mlx.handle import Handle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(eq=False, repr=False)
class Image(Handle):
    """A picture to draw into: (h, w, 4) uint8, in memory blue, green, red, alpha."""

    pixels: NDArray[np.uint8]

    @property
    def width(self) -> int:
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        return int(self.pixels.shape[0])

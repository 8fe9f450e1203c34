"""Renders a picture strip by strip, so that an interrupt costs one strip.

A strip is as high as the picture: its rows are as many as those of the picture, which the threads share.
"""

from __future__ import annotations

import argparse
import struct
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

from minirt.cli.arguments import Region
from minirt.cli.part_file import PartFile

if TYPE_CHECKING:
    import numpy as np

    from minirt.image import Image
    from minirt.rendering import Renderer
    from minirt.scene import Scene

STRIP, MOST = 2**21, 64  # rays of a strip, and strips; strips are longer where there would be more of them
COUNT = struct.Struct("<q")  # rays of a strip whose light was not finite


class Strips:
    """The strips of a picture that is being rendered."""

    def __init__(self, scene: Scene, options: argparse.Namespace, size: tuple[int, int], samples: int) -> None:
        from minirt.rendering.packing.camera import strips_of

        self.scene = scene
        self.size = size
        self.samples = samples
        self.region = options.region or Region(0, 0, *size)
        self.rays = self.region.width * self.region.height * samples
        length = max(STRIP, self.rays // MOST)
        self.strips = [Region(*each) for each in strips_of(self.region, samples, length)]
        self.done = self.found = 0  # strips that are ready, and those of them that a program before has rendered
        self.not_finite = 0  # rays

    def share(self, renderer: Renderer) -> float:
        """Return the share of the work of this program that is done."""
        rows = min(1.0, int(renderer.runner.next_row[0]) / self.region.height)
        return (self.done - self.found + rows) / max(len(self.strips) - self.found, 1)

    def render(self, part: PartFile, renderer: Renderer, **settings: Any) -> Image:
        """Render the strips that the part file lacks, and return the picture."""
        import numpy as np

        import minirt
        from minirt.image import Image

        shape = self.region.height, self.region.width, 3
        levels = np.empty(shape, np.uint8)
        light = np.empty(shape) if settings["linear"] else None
        for number, strip in enumerate(self.strips):
            at = slice(strip.x - self.region.x, strip.x - self.region.x + strip.width)
            arrays = [levels[:, at]] if light is None else [levels[:, at], light[:, at]]
            if self.restore(part, number, arrays):
                self.found += 1
            else:
                render = partial(minirt.render, self.scene, *self.size, samples=self.samples, region=tuple(strip))
                start = perf_counter()
                image = render(**settings)
                seconds = perf_counter() - start
                for array, made in zip(arrays, (image.array, image.linear), strict=False):
                    array[...] = made
                self.not_finite += renderer.not_finite
                data = COUNT.pack(renderer.not_finite) + b"".join(array.tobytes() for array in arrays)
                part.offer(number, data, seconds)
            self.done += 1
        return Image(levels, light, None, self.scene.camera.tone)

    def restore(self, part: PartFile, number: int, arrays: list[np.ndarray]) -> bool:
        """Fill arrays with a strip of the part file; False where it lacks the strip."""
        import numpy as np

        data = part.read(number, COUNT.size + sum(array.nbytes for array in arrays))
        if data is None:
            return False
        self.not_finite += COUNT.unpack_from(data)[0]
        start = COUNT.size
        for array in arrays:
            found = np.frombuffer(data, array.dtype, array.size, start)
            array[...] = found.reshape(array.shape)
            start += array.nbytes
        return True

"""Jobs: pictures, cut into bands that anyone may render with the same result."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from math import sqrt
from operator import itemgetter
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from minirt import __version__
from minirt.formats import tiff
from minirt.kernel.pixels import TILE
from minirt.rendering import settings as rendering_settings
from minirt.rendering.outcome import Outcome
from minirt.rendering.packing.camera import Region, cut_for
from minirt.rendering.settings import RenderSettings
from minirt.scene import Scene

ROWS = 64  # of a band, where the next two leave the choice
MOST_PIXELS = 2**21  # of a band, whose light takes 48 MiB; but at least one row of tiles
LEAST_PIXELS = 2**15  # of a band: twice those from which on the estimated error of a picture is promised
RAYS, MOST_BANDS = 2**21, 64  # rays of a band, and bands that are so small because of their rays


class Job(NamedTuple):
    """A picture of a scene, or a region of it, to be rendered by anyone, as a whole or in bands: jobs, too."""

    scene: Scene
    size: tuple[int, int]  # of the whole picture, in pixels
    settings: RenderSettings  # their region is that of a band
    number: int = 0  # of a band in its job, or of a picture in its film
    bits: int | None = None  # of the strips of a TIFF file that are made of it, None for arrays

    @property
    def region(self) -> Region:
        """The rectangle of the picture that is rendered; RenderError where it does not lie in the picture."""
        return cut_for(self.settings.region, *self.size).region

    @property
    def what(self) -> str:
        """The name of a band in messages."""
        _, first, _, height = self.region
        return f"rows {first} to {first + height - 1}" if self.settings.region else "a picture"

    def bands(self, bits: int | None = None) -> list[Job]:
        """Cut the picture into bands, of which strips of `bits` a channel are made if they are given."""
        samples = 1 if self.settings.samples == "auto" else self.settings.samples
        pairs = enumerate(rows_of(self.region, samples))
        return [Job(self.scene, self.size, self.settings.replace(region=each), number, bits) for number, each in pairs]

    def work(self, *more: object) -> str:
        """Return what tells the job from others: a hash of all that the bits of the picture, or of `more`, depend
        on."""
        settings = f"{__version__} {self.size} {self.settings.replace(threads=None)} {more}"
        return rendering_settings.identity(self.scene, settings)


class Strips(NamedTuple):
    """Compressed strips of a TIFF file, made of a band; none of a picture that is in a file of its own already."""

    parts: tuple[bytes, ...]
    reached: Outcome | None


Workers: TypeAlias = Any  # an executor of concurrent.futures, a function that makes one, or a dask client
Made: TypeAlias = Any  # what is made of a band: an `Image`, or `Strips` where the band has bits


def render_band(band: Job) -> Made:
    """Render a band in this process."""
    image = rendering_settings.rendered(band.scene, band.size, band.settings)
    if band.bits:
        return Strips(tiff.strips(image.array if band.bits == 8 else image.deep), image.reached)
    return image


def rows_of(region: Region, samples: int) -> list[Region]:
    """Divide a region of a picture into bands of whole rows of tiles, which depend on its size and samples alone.

    So does the estimated error of a picture that is made of bands, whoever renders them.
    """
    x, y, width, height = region
    rows = min(max(ROWS, LEAST_PIXELS // width), max(TILE, MOST_PIXELS // width))
    tiles = -(-height // TILE)
    count = max(1, round(height / rows), min(MOST_BANDS, width * height * samples // RAYS))
    ends = [min(height, TILE * (tiles * number // count)) for number in range(count + 1)]
    return [Region(x, y + first, width, end - first) for first, end in pairwise(ends) if end > first]


def whole(parts: Sequence[tuple[Region, Outcome | None]]) -> Outcome | None:
    """Return the outcome of a picture that consists of bands, None where one of them has none.

    The square of an error is a mean over pixels: that of the whole is the mean of the squares of its bands. Where each
    of them is at most the goal the whole is, too. Seconds are those of all workers together.
    """
    in_order = sorted(parts, key=itemgetter(0))  # so that sums are rounded alike
    outcomes = [each for _, each in in_order if each is not None]
    if not outcomes or len(outcomes) < len(parts):
        return None
    mean = partial(np.average, weights=[region.width * region.height for region, _ in in_order])
    return Outcome(
        samples=float(mean([each.samples for each in outcomes])),
        most=max(each.most for each in outcomes),
        error=sqrt(mean([each.error**2 for each in outcomes])),
        seconds=sum(each.seconds for each in outcomes),
        goal=outcomes[0].goal,
        rounded=any(each.rounded for each in outcomes) and not all(each.is_reached for each in outcomes),
        rounding=sqrt(mean([each.rounding**2 for each in outcomes])),
    )

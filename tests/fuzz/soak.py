"""Soak test of the renderer: scenes of the fuzzer of extreme scenes, in many sizes; its usage stays flat.

python -m tests.fuzz.soak 60    # minutes
python -m tests.fuzz.soak 60 7  # with another seed

The usage is printed each minute. The run fails where it grows: see `tests/usage.py`. `make soak` runs this, and
`tests/viewer/monkey.py` for the window.
"""

from __future__ import annotations

import random
import sys
import time
from collections.abc import Callable
from functools import partial

import numpy as np

from minirt.rendering.renderer import Renderer
from minirt.scene import Scene
from tests import environment
from tests.fuzz.mutations import seeded
from tests.fuzz.scenes import make_extreme, read
from tests.usage import Record, Usage

RENDERERS = [Renderer(1, precision) for precision in ("double", "single")]
LARGEST = (320, 240)  # pixels of a picture; small ones are as frequent


def soak(share: Callable[[int], float], seed: int, record: Record) -> int:
    """Render until `share(pictures)` is 1, the share of the run that is over after so many; return their number."""
    pictures, number = 0, 0
    while (progress := share(pictures)) < 1:
        chance = seeded("soak", seed * 10**9 + number)
        number += 1
        scene = read(make_extreme(chance))
        if scene is not None:
            render(scene, chance)
            pictures += 1
        record.note(progress)
    record.note(1.0)
    return pictures


def render(scene: Scene, chance: random.Random) -> None:
    """Render a scene in some size and precision."""
    width, height = (int(most ** chance.random()) for most in LARGEST)
    assert chance.choice(RENDERERS).render(scene, np.zeros((height, width, 4), np.uint8))


def share_of_time(seconds: float) -> Callable[[int], float]:
    """Return a function that tells which share of so many seconds is over."""
    start = time.monotonic()
    return lambda _: (time.monotonic() - start) / seconds


if __name__ == "__main__":
    environment.prepare()
    for each in RENDERERS:
        each.kernels.specialised_after = float("inf")  # compiles nothing
    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    record = Record(max(6, round(minutes)), Usage.of, partial(print, flush=True))
    number = soak(share_of_time(60 * minutes), seed, record)
    print(f"{number} pictures, {record.verdict}")
    sys.exit(not record.is_flat)

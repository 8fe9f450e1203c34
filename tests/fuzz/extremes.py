"""Fuzzer of extreme valid scenes: what the reader accepts renders, without warnings, NaN or infinities.

Kernels that were compiled ahead of time draw them, since a specialised kernel for each would take seconds.
"""

from __future__ import annotations

import random
import warnings
from functools import cache

import numpy as np

from minirt.errors import SceneError
from minirt.rendering import Renderer
from minirt.scene import Scene, parse
from tests.fuzz import scene_fields, scene_grammar, scene_words
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.scene_files import folder

WIDTH, HEIGHT = 8, 6
PRECISIONS = ("double", "single")
EXTREME = ("0", "5e-324", "-5e-324", "1e-308", "1e-160", "1e-30", "0.001", "1e8", "1e15", "-1e15", "999999999999999.9")
LONELY = sorted(set(scene_grammar.FORMS) - scene_grammar.ONCE)


def make(chance: random.Random) -> bytes:
    """Make a scene; in many of its numbers stand extreme ones."""
    codes = ["A", "C", *(code for code in ("bg", "L") if chance.random() < 0.7)]
    codes += chance.choices(LONELY, k=chance.randint(1, 5))
    return "\n".join(" ".join(extreme(scene_words.line(code, chance), chance)) for code in codes).encode()


def extreme(words: list[str], chance: random.Random) -> list[str]:
    """Replace some numbers of a line by extreme ones; a line that this makes wrong is made anew."""
    for _ in range(20):
        tried = [words[0], *(",".join(other(part, chance) for part in word.split(",")) for word in words[1:])]
        if scene_grammar.code_of(" ".join(tried)) not in ("wrong", "open"):
            return tried
    return words


def other(part: str, chance: random.Random) -> str:
    """Return a number, most often as it is."""
    is_number = not np.isnan(scene_fields.value_of(part))
    return chance.choice(EXTREME) if is_number and chance.random() < 0.15 else part


def check(data: bytes) -> str:
    """Render the scene in both precisions."""
    try:
        scene = parse(data, folder() / "fuzz.rt").scene
    except SceneError:
        return "refused"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for precision in PRECISIONS:
            render(scene, precision)
    return "rendered"


@cache
def renderer(precision: str) -> Renderer:
    """Return a renderer that compiles nothing."""
    made = Renderer(1, precision)
    made.kernels.specialised_after = float("inf")
    return made


def render(scene: Scene, precision: str) -> None:
    """Render a scene: all of the picture, with finite light."""
    pixels, light = np.zeros((HEIGHT, WIDTH, 4), np.uint8), np.full((HEIGHT, WIDTH, 3), np.nan)
    assert renderer(precision).render(scene, pixels, 1, light)
    assert (pixels[..., 3] == 255).all(), "pixels were left out"
    assert np.isfinite(light).all(), "light that is not finite"
    assert (light >= 0).all(), "light below 0"


FUZZER = Fuzzer(make, check, 40)

"""Plant hypotheses of `minirt.compare` in pictures of random scenes: python -m tests.planting --pairs 0 40.

The light of planted pictures is drawn by the formulas of `minirt.compare.lighting` with known factors;
`tests/test_compare.py` holds those of this program equal to the kernel's, and plants by edited scenes, too.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import minirt
from minirt.compare import Comparison, compare, lighting
from minirt.compare.geometry import reach, see
from minirt.compare.pictures import EDGE
from minirt.compare.sky import background
from minirt.compare.table import OURS, SOFT_FADING, TABLE, Guess, Hypothesis
from minirt.scene import Scene

Bytes = NDArray[np.uint8]  # (h, w, 3)
SIZE = 480, 270
VISIBLE, LEVELS = 0.01, 6  # share of pixels that a planted hypothesis changes by more than so many levels
VISIBLE_EDGES = 0.0015  # of one that only moves edges
SKY, RISING = (40, 90, 160), (0.4, 0.2, -0.3)  # at the horizon, and what is added up to the zenith, from 0 to 1
SPECKS = 0.25
SCENES, STRIDE = 20, 1000  # that are tried until one shows what is planted, and how far their seeds are apart
EXPONENTS = 16, 50, 200


def student_scene(seed: int) -> Scene:
    """A scene as students write them: a floor, a few balls and cylinders, one or two lamps, and a camera."""
    random = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(random.uniform(low, high))

    def place(low: float, high: float) -> tuple[float, float, float]:
        return between(-4, 4), between(low, high), between(-3, 3)

    def colour(least: int) -> tuple[int, ...]:
        return tuple(map(int, random.integers(least, 256, 3)))

    eye = between(-7, 7), between(1.5, 6), between(-12, -8)
    items = [
        minirt.Ambient(between(0.1, 0.3), colour(150)),
        minirt.Camera.look_at(eye, (between(-1, 1), between(0, 1.5), between(-1, 1)), fov=between(50, 90)),
        minirt.Light((between(-8, 8), between(6, 12), between(-8, 0)), between(0.5, 0.8), colour(150)),
        minirt.Plane((0, -1, 0), (0, 1, 0), colour(40)),
    ]
    if random.random() < 0.3:
        items.append(minirt.FurtherLight((between(-8, 8), between(6, 12), between(-8, 0)), 0.3, colour(150)))
    if random.random() < 0.4:
        items.append(minirt.Plane((0, 0, between(7, 12)), (0, 0, -1), colour(40)))
    if random.random() < 0.3:
        items.append(minirt.Plane((0, 14, 0), (0, 1, 0), colour(40)))
    items += [minirt.Sphere(place(0, 2), between(1, 2.6), colour(40)) for _ in range(random.integers(2, 4))]
    for _ in range(random.integers(1, 3)):
        axis = random.normal(size=3)
        axis *= np.copysign(1 / np.linalg.norm(axis), axis[1])
        written = "cy 0,0,0 {},{},{}".format(*axis / np.abs(axis).max())  # longer than 1, which the reader takes
        sizes = between(0.8, 2), between(1.5, 4)
        items.append(minirt.Cylinder(place(0, 2), tuple(axis), *sizes, colour(40), source=written))
    if random.random() < 0.5:
        items.append(minirt.Cone(place(2, 3), (0, -1, 0), between(1, 2), between(1, 3), colour(40)))
    return Scene(items)


def draw(scene: Scene, guess: Guess, size: tuple[int, int] = SIZE, seed: int = 0) -> Bytes:
    """Draw a scene as a guess says, with highlights of half of the light; light fades from a distance of 8 on."""
    width, height = size
    y, x = np.mgrid[0:height, 0:width].reshape(2, -1).astype(float)
    seen = see(scene, size, x, y, guess)
    factors = lighting.usual_factors(scene, guess)
    factors[[lighting.OBJECT, lighting.SPECULAR, lighting.MIRROR]] = 0.1, 0.5, 0.3
    power = lighting.exponent(guess)
    factors[lighting.LAMPS :] *= (8 / reach(scene)) ** power
    factors[lighting.LAMPS :] *= 1 + 8 * SOFT_FADING.get(guess["fading"], 0.0)
    factors[lighting.FADED] = 0.02 * reach(scene) * (guess["fading"] == "linear")
    terms = lighting.columns(scene, seen, guess, factors)
    skies = {"own": (lighting.numbers(SKY), np.zeros(3)), "gradient": (lighting.numbers(SKY), RISING)}
    sky = np.array(skies.get(guess["background"], background(scene)))
    shown = lighting.drawn(terms, seen, guess, factors, sky)
    if guess["acne"]:
        specks = (np.random.default_rng(seed).random(len(x)) < SPECKS) & (seen.owner >= 0)
        shown[specks] = lighting.shown_levels(terms[specks, :, :1] @ factors[:1], guess)
    if guess["colours"] == "swapped":
        shown = shown[:, ::-1]
    levels: Bytes = np.rint(255 * shown).astype(np.uint8).reshape(height, width, 3)
    return levels


def compared(scene: Scene, levels: Bytes, folder: Path) -> Comparison:
    """Compare a picture with its scene, by a file."""
    Image.fromarray(levels).save(folder / "theirs.png")
    return compare(scene, folder / "theirs.png")


def are_visible(scene: Scene, rows: Sequence[Hypothesis]) -> bool:
    """Whether each of some hypotheses changes the picture beside the others, and it shows anything."""
    together = draw(scene, merged(rows))
    if np.ptp(together, axis=(0, 1)).max() <= EDGE:
        return False
    for row in rows:
        without = draw(scene, merged([each for each in rows if each is not row]))
        changed = (np.abs(together.astype(int) - without).max(axis=-1) > LEVELS).mean()
        if changed < (VISIBLE_EDGES if row.name == "pixel" else VISIBLE):
            return False
    return True


def merged(rows: Sequence[Hypothesis]) -> Guess:
    """Return the guess that makes all changes of some rows."""
    guess = dict(OURS)
    for row in rows:
        guess |= row.changes
    return guess


class Result(NamedTuple):
    """What was found of planted hypotheses."""

    found: bool
    wrong: bool  # a cause that was not planted is told as a fact


def judged(rows: Sequence[Hypothesis], found: Comparison) -> Result:
    """Whether all hypotheses were found, and something else with certainty."""
    planted, named = {row.name for row in rows}, {each.name for each in found.causes}
    return Result(planted <= named, bool(named - planted) and found.sure)


def main() -> int:
    """Plant rows of the table alone, or pairs of them, for a range of seeds; print what is found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=int)
    parser.add_argument("end", type=int)
    parser.add_argument("--pairs", action="store_true")
    chosen = parser.parse_args()
    table = [row for row in TABLE if row.name != "specular" or row.changes["specular"][1] in EXPONENTS]
    results = []
    with TemporaryDirectory() as folder:
        for seed in range(chosen.first, chosen.end):
            rows = random.Random(seed).sample(table, 2) if chosen.pairs else [table[seed % len(table)]]
            if len({row.name for row in rows}) < len(rows):
                continue
            scenes = map(student_scene, range(seed, seed + SCENES * STRIDE, STRIDE))
            scene = next((each for each in scenes if are_visible(each, rows)), None)
            if scene is None:
                print(f"{seed}: {', '.join(row.name for row in rows)} changes none of {SCENES} scenes", flush=True)
                continue
            found = compared(scene, draw(scene, merged(rows), seed=seed), Path(folder))
            results.append(judged(rows, found))
            told = ", ".join(f"{each.name} {each.value}" for each in found.causes)
            planted = ", ".join(f"{row.name} {row.value}" for row in rows)
            print(f"{seed}: planted {planted}; told {told}; {found.explained:.1%}; {results[-1]}", flush=True)
    count = len(results)
    print(f"{count} pictures: {sum(each.found for each in results)} found, {sum(each.wrong for each in results)} wrong")
    return 0


if __name__ == "__main__":
    sys.exit(main())

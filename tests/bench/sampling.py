"""Automatic beside uniform sampling, on scenes drawn at random: `python -m tests.bench.sampling [CELLS [SEED]]`.

A cell is a scene and an error that is asked for. Its ratio is the processor time of automatic sampling by that of the
smallest uniform number of samples with at most the same true error. The product of the differences from two pictures of
many samples, independent of each other, has its square as mean: so their own errors are no part of it.
"""

from __future__ import annotations

import sys
from bisect import bisect_left
from functools import partial
from math import inf
from typing import NamedTuple

import numpy as np

import minirt
from minirt.rendering.renderer import Renderer
from minirt.report.bench import runs
from tests.paths import SCENES
from tests.test_random_materials import material_scene

WIDTH, HEIGHT = 320, 180
GOALS, LEAST, MOST = 3, 0.002, 0.02  # errors of a scene, from the least to the most
REFERENCES = 700, 709  # samples of the pictures that tell true errors; none of `COUNTS`, to be independent of them
COUNTS = sorted({round(2 ** (k / 5)) for k in range(51)})  # uniform numbers of samples
TURNS, SECONDS = 3, 0.02  # of each way to sample, and how long a turn takes at least


class Cell(NamedTuple):
    """Automatic sampling of a scene for an error that was asked for."""

    seed: int
    goal: float
    excess: float  # the true error by the goal
    uniform: int  # samples of a pixel with the same error
    ratio: float  # of processor times


def drawn_scene(seed: int) -> minirt.Scene:
    """Draw some of the shapes, materials and lights of a scene with all of them, and maybe a fence of thin cylinders, a
    mesh, lights with a size and a lens."""
    random, made = np.random.default_rng([seed, 1]), material_scene(seed)

    def maybe(share: float, low: float, high: float) -> float | None:
        return float(np.exp(random.uniform(np.log(low), np.log(high)))) if random.random() < share else None

    floor, *solids = made.shapes
    shapes = [floor if random.random() < 0.5 else floor.replace(clouds=None)]
    shapes += [solids[i] for i in random.permutation(len(solids))[: random.integers(1, 9)]]
    if thin := maybe(0.3, 0.01, 0.2):
        xs, axis = np.arange(-6, 6, random.uniform(0.2, 0.8)), (random.uniform(-0.6, 0.6), 0.8, 0.0)
        shapes += [minirt.Cylinder((float(x), 0.0, 0.0), axis, thin, 6.0, (255, 255, 255)) for x in xs]
    if size := maybe(0.3, 1, 4):
        name = ("icosphere", "knot", "teapot")[random.integers(3)]
        shapes.append(
            minirt.Mesh(str(SCENES / f"meshes/{name}.obj"), tuple(random.normal(size=3)), size, (220, 180, 90))
        )
    lights = [each.replace(size=maybe(0.3, 0.3, 4)) for each in made.lights[: random.integers(1, 5)]]
    sky = [made.background] if made.background and random.random() < 0.5 else []
    camera = made.camera.replace(lens=maybe(0.3, 0.05, 0.5))
    return minirt.Scene([made.ambient, camera, *sky, *lights, *shapes], made.file)


class Measured:
    """A scene with its true picture."""

    def __init__(self, seed: int) -> None:
        self.scene, self.renderer, self.errors = drawn_scene(seed), Renderer(1), dict[int, float]()
        self.renderer.kernels.specialised_after = inf  # no compiler works beside it
        self.pixels, self.light = np.zeros((HEIGHT, WIDTH, 4), np.uint8), np.zeros((HEIGHT, WIDTH, 3))
        self.truths = [np.clip(self.draw(count), 0, 1) for count in REFERENCES]

    def draw(self, samples: int | float) -> np.ndarray:
        """Return light with so many samples a pixel, or with an error, which is not whole."""
        way = self.renderer.render if isinstance(samples, int) else self.renderer.reach
        way(self.scene, self.pixels, samples, linear=self.light)
        return self.light

    def error(self, samples: int | float) -> float:
        """Return the true error of a way to sample."""
        if samples not in self.errors:
            light = np.clip(self.draw(samples), 0, 1)
            products = (light - self.truths[0]) * (light - self.truths[1])
            self.errors[samples] = float(np.sqrt(max(products.mean(), 0.0)))
        return self.errors[samples]

    def cell(self, seed: int, goal: float) -> Cell:
        """Measure a cell; both ways take turns."""
        true = self.error(goal)
        uniform = COUNTS[bisect_left(COUNTS[:-1], -true, key=lambda count: -self.error(count))]
        ways = partial(self.draw, goal), partial(self.draw, uniform)
        times = [[min(run.cpu for run in runs(way, 1, SECONDS)) for way in ways] for _ in range(TURNS)]
        auto, plain = np.min(times, axis=0)
        return Cell(seed, goal, true / goal, uniform, auto / plain)


def cells(count: int, seed: int | None = None) -> list[Cell]:
    """Measure cells of scenes, drawn from a seed on, and print them."""
    seed, found = int(np.random.default_rng().integers(10**6)) if seed is None else seed, list[Cell]()
    while len(found) < count:
        measured, random = Measured(seed), np.random.default_rng([seed, 2])
        for goal in np.exp(random.uniform(np.log(LEAST), np.log(MOST), GOALS)).tolist():
            found.append(measured.cell(seed, goal))
            print(found[-1], file=sys.stderr, flush=True)
        seed += 1
    return found


def summary(found: list[Cell]) -> str:
    """Return what cells have in common."""
    ratios, excesses = (np.array([getattr(cell, name) for cell in found]) for name in ("ratio", "excess"))
    return (
        f"{len(found)} cells from seed {found[0].seed} on. Time of automatic by that of uniform sampling of its error: "
        f"median {np.median(ratios):.2f}, worst {ratios.max():.2f}, at most 1.1 in {(ratios <= 1.1).mean():.0%}.\n"
        f"True error by the wanted one: median {np.median(excesses):.2f}, worst {excesses.max():.2f}, at most 1 in "
        f"{(excesses <= 1).mean():.0%}."
    )


if __name__ == "__main__":
    print(summary(cells(*map(int, sys.argv[1:] or ["100"]))))

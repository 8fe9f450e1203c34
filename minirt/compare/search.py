"""The search for the guess that explains a picture best.

First the camera and the shapes, by how well each region that traced rays give is one colour in one light, whatever
they are; then the light; then all rows of the table in turn, from the best few beginnings.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any

import numpy as np

from minirt.compare import lighting
from minirt.compare.cameras import CAMERA, FOVS, TURNED, cameras, differences, drawn_by, is_aimed
from minirt.compare.changed_shapes import SHAPES, Mask, changed_scene
from minirt.compare.geometry import Floats, Seen, plain_shapes, see, see_each, slopes
from minirt.compare.lighting import Fit
from minirt.compare.table import GEOMETRY, LIGHT, OURS, TABLE, Guess, Hypothesis, is_near, values
from minirt.scene import Scene

COARSE, FINE, LARGE = 900, 2600, 10_000  # pixels of the samples
MOST_KEPT = 1_000_000  # pixels whose hits are kept
FINER = 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 1.005, 1.01, 1.02, 1.05, 1.1, 1.25
ROLLS = 1.0, 5.0, 20.0, 45.0, 90.0  # degrees
ANGLES = range(-60, 61, 2)  # degrees, by which cameras are turned about one axis where none of the table fits
TURNS = 2.0, 1.0, 1.0, 0.5, 0.5, 0.2, 0.2  # degrees, by which they are turned further, about each axis
AIMED, CLEARLY = 8, 0.6  # how many, and how much evener one must be than those of the table
ZOOM = 60.0  # degrees of a turn for which a field of view is twice as wide
FINE_TURN = 0.2  # degrees
EVEN = 0.001  # unevenness of a camera and of sizes that may be right
NAMED, FREE = 7, 3  # cameras of the table, and those with another field of view, from which shapes are tried
BEGINNINGS, FINALISTS = 8, 3
AT_ONCE = 32  # cameras that are traced in one call
ALIKE, ALIKE_CAMERA = 1.05, 1.03  # scores up to this times another are as good
NEAR_SCORE, NEAR_CAMERA = 0.0004, 0.00004  # as are those that differ by a tenth, for cameras a hundredth of a level
NEAR = 0.05  # by which slopes and axes of cameras that draw nearly the same differ
BETTER, BETTER_YET = 0.97, 0.99  # a step is taken where the score falls to this share; that of a large sample
SPECKLED, SPECK = 0.01, 0.1  # share of pixels that are so much darker than their neighbours, in pictures with acne


class Case:
    """A scene, a picture of another program, and samples of its pixels."""

    def __init__(self, scene: Scene, picture: Floats) -> None:
        self.scene, self.picture = scene, picture
        self.height, self.width = picture.shape[:2]
        self.judged = plain_shapes(scene)
        has_specks = speck_share(picture) > SPECKLED
        self.table = [row for row in TABLE if self.tells(row) and (row.name != "acne" or has_specks)]
        self.light = [row for row in self.table if row in LIGHT]
        self.aspect = self.width / self.height
        self.cameras = cameras(scene.camera, self.aspect)
        self.kept: dict[Any, Seen] = {}
        self.samples: dict[int, tuple[Floats, Floats, Floats]] = {}
        self.scores: dict[Any, tuple[float, int]] = {}
        self.unevenness: dict[Any, float] = {}

    def tells(self, row: Hypothesis) -> bool:
        """Whether a row changes this scene, if it is about shapes."""
        if row.name == "missing":
            return set(row.value) <= {shape.plural for shape in self.scene.shapes}
        return not set(row.changes) <= set(SHAPES) or changed_scene(self.scene, OURS | row.changes) is not self.scene

    def sample(self, count: int) -> tuple[Floats, Floats, Floats]:
        """Return x, y and colours of about that many pixels, on a slanted grid."""
        if count in self.samples:
            return self.samples[count]
        step = max(1.0, (self.width * self.height / count) ** 0.5)
        rows = np.arange(step / 2, self.height, step)
        places = [((np.arange(0, self.width, step) + shift * step) % self.width, row)
                  for shift, row in zip((0.618034 * np.arange(len(rows))) % 1, rows, strict=True)]  # fmt: skip
        x = np.concatenate([np.floor(along) for along, _ in places])
        y = np.concatenate([np.full(len(along), float(int(row))) for along, row in places])
        self.samples[count] = x, y, self.picture[y.astype(int), x.astype(int)]
        return self.samples[count]

    def see(self, guess: Guess, count: int) -> Seen:
        """Return what the pixels of a sample show under a guess; the last ones are kept."""
        key = count, guess["reflections"], *(guess[name] for name in GEOMETRIC)
        if key not in self.kept:
            if sum(many for many, *_ in self.kept) > MOST_KEPT:
                self.kept.clear()
            x, y, _ = self.sample(count)
            self.kept[key] = see(self.scene, (self.width, self.height), x, y, guess)
        return self.kept[key]

    def fit(self, guess: Guess, count: int = FINE, counted: Mask | None = None, fixed: str = "") -> Fit:
        """Return how a guess explains a sample, or the pixels of it that are counted, as `lighting.fit` does."""
        seen = self.see(guess, count)
        judged = self.judged[seen.owner] if counted is None else counted
        return lighting.fit(self.scene, seen, self.sample(count)[2], guess, judged, fixed)

    def score(self, guess: Guess, count: int = FINE) -> tuple[float, int]:
        """Return the score of a guess on a sample, and the number of its odd factors; all of them are kept."""
        key = count, *guess.values()
        if key not in self.scores:
            fit = self.fit(guess, count)
            self.scores[key] = fit.score, fit.odd
        return self.scores[key]

    def evenest(self, guesses: Iterable[Guess]) -> list[Guess]:
        """Sort guesses by how far their regions are from being one colour in one light each; first the evenest.

        `unevenness` keeps these numbers, by the values of the guesses: means of squares of levels from 0 to 1. Cameras
        that look at the same shapes are traced at once: the rays of one take less time than a call.
        """
        x, y, colours = self.sample(COARSE)
        groups: dict[Any, list[Guess]] = {}
        for each in guesses:
            groups.setdefault(tuple(each[name] for name in GEOMETRIC if name not in CAMERA), []).append(each)
        for group in groups.values():
            for start in range(0, len(group), AT_ONCE):
                some = group[start : start + AT_ONCE]
                for each, seen in zip(some, see_each(self.scene, (self.width, self.height), x, y, some), strict=True):
                    residual = np.minimum(lighting.unevenness(seen, colours, each), lighting.STEADY**2)
                    self.unevenness[tuple(each.values())] = float(residual.mean())
        return sorted(guesses, key=lambda each: self.unevenness[tuple(each.values())])


GEOMETRIC = *dict.fromkeys(name for row in GEOMETRY for name in row.changes), "scale", *TURNED


def search(case: Case) -> Guess:
    """Find the guess that explains the picture best, by steps that take the best few guesses of the step before."""
    seen_from = case.evenest(case.cameras.values())
    if case.unevenness[tuple(seen_from[0].values())] > EVEN:  # wrong sizes of shapes may hide that a camera is right
        radii = [row.changes for row in case.table if row.name == "radius"]
        named = [each for each in seen_from if each["scale"] == 1.0]
        seen_from = case.evenest([*seen_from, *(each | changes for each in named for changes in radii)])
    free = [each for each in seen_from if each["scale"] != 1.0]
    named = [each for each in seen_from if each["scale"] == 1.0]
    seen_from = named[:NAMED] + free[:FREE] + turned(case, case.unevenness[tuple(seen_from[0].values())])
    names = "cylinder", "radius", "cone"
    shaped = [[OURS[name], *(row.changes[name] for row in case.table if name in row.changes)] for name in names]
    combined = [dict(zip(names, each, strict=True)) for each in product(*shaped)]
    variants = case.evenest([each | changes for changes in combined for each in seen_from])
    undrawn = [row for row in case.table if row.name in ("missing", "inside")]  # black: one colour in any light
    matt = undrawn + [row for row in case.light if row.name not in ("specular", "reflections")]
    lit = [descend(case, each, by_gain(case, each, matt), 1) for each in [OURS, *variants[:BEGINNINGS]]]
    best = sorted(lit, key=case.score)[:FINALISTS]
    found = [simplest(case, descend(case, each, case.table, 3)) for each in best]
    return descend(case, min(found, key=case.score), case.light, 1, LARGE)


def speck_share(picture: Floats) -> float:
    """The share of pixels that are clearly darker than both of their neighbours at the sides."""
    light = picture.sum(axis=-1)
    beside = np.minimum(light[:, :-2], light[:, 2:])
    return float((beside - light[:, 1:-1] > SPECK).mean())


def turned(case: Case, least: float) -> list[Guess]:
    """Return a list of one camera, which is turned, rolled and zoomed, in steps that get smaller, until its regions are
    evenest. The list is empty where the evenest camera of the table, of unevenness `least`, is nearly as even, and
    where no camera fits."""

    def unevenness(guess: Guess) -> float:
        return case.unevenness[tuple(guess.values())]

    if least < EVEN:
        return []
    starts = [{"mirrored": hand, name: angle} for hand in (False, True) for name in TURNED for angle in ANGLES]
    found = case.evenest([OURS | each for each in starts])[:AIMED]
    for step in TURNS:
        near = [[each, *neighbours(each, step)] for each in found]
        case.evenest([each for some in near for each in some])
        found = [min(some, key=unevenness) for some in near]
    best = min(found, key=unevenness)
    return [best] if unevenness(best) < min(CLEARLY * least, EVEN) else []


def neighbours(guess: Guess, step: float) -> list[Guess]:
    """Return cameras that are turned, rolled or zoomed by a step, in degrees, from that of a guess."""
    moved = [guess | {name: guess[name] + sign * step} for name in TURNED for sign in (1, -1)]
    zoom = 1 + step / ZOOM
    return moved + [guess | {"scale": guess["scale"] * factor} for factor in (zoom, 1 / zoom)]


def steps(case: Case, guess: Guess, rows: Iterable[Hypothesis]) -> dict[str, list[Guess]]:
    """Return the neighbours of a guess by the parameter in which they differ: a row of the table more or less, or, with
    rows of the camera, a little more or less of its free numbers."""
    found: dict[str, list[Guess]] = {}
    for row in rows:
        (name, value), *_ = row.changes.items()
        if guess[name] != value and (name != "specular" or is_near(guess[name], value)):
            found.setdefault(name, []).append(guess | row.changes)
            if name in SHAPES:  # another change of shapes, if it is wrong, may hide that this one is right
                found[name].append(guess | {each: OURS[each] for each in SHAPES} | row.changes)
    for name, near in found.items():
        if guess[name] != OURS[name]:
            near.append(guess | {name: OURS[name]})
    if "fov" in found:  # the rows are those of the camera, too
        # Other values of "fov" are factors of the slopes, as the scale is: it takes their place.
        plain = guess | {"fov": "square" if guess["fov"] == "square" else "horizontal"}
        across = [slopes(case.scene.camera, case.aspect, each)[0] for each in (guess, plain)]
        scales = [guess["scale"] * across[0] / across[1] * factor for factor in FINER]
        found["fov"] = [each | {"scale": 1.0} for each in found["fov"]]
        found["scale"] = [plain | {"scale": scale} for scale in (*scales, 1.0)]
        found["roll"] = [guess | {"roll": guess["roll"] + sign * turn} for turn in ROLLS for sign in (1, -1)]
        found["roll"].append(guess | {"roll": 0.0})
        if is_aimed(guess):
            found["yaw"] = neighbours(guess, FINE_TURN)
    return found


def by_gain(case: Case, guess: Guess, rows: Iterable[Hypothesis]) -> list[Hypothesis]:
    """Sort rows by how well a guess explains the picture with each of them."""
    return sorted(rows, key=lambda row: case.score(guess | row.changes))


def descend(case: Case, guess: Guess, rows: Iterable[Hypothesis], rounds: int, count: int = FINE) -> Guess:
    """Improve a guess, one parameter after the other, until no step explains the picture clearly better."""
    best, _ = case.score(guess, count)
    for _ in range(rounds):
        before = best
        for name in steps(case, guess, rows):
            for each in steps(case, guess, rows).get(name, ()):
                score, _ = case.score(each, count)
                if score < best * (BETTER if count == FINE else BETTER_YET):
                    guess, best = each, score
        if best == before:
            break
    return guess


def simplest(case: Case, guess: Guess) -> Guess:
    """Return the guess of fewest differences that explains the picture as well: with a camera of the table that draws
    nearly the same in place of free numbers, and with plainer light."""
    key = drawn_by(case.scene.camera, case.aspect, guess)
    others = [guess | {"fov": fov, "scale": 1.0} for fov in FOVS] + [guess | {"roll": 0.0}]
    cameras = [*case.cameras.items(), *((drawn_by(case.scene.camera, case.aspect, each), each) for each in others)]
    apart = np.abs(np.array([drawn for drawn, _ in cameras]) - key).max(axis=1)
    near = [each for away, (_, each) in zip(apart, cameras, strict=True) if away < NEAR]
    lights = [{"ambient": form, "fading": fading} for form in values("ambient") for fading in (0, 1, 2)]
    lights.append({"brightness": 2})
    frames = [{name: each[name] for name in CAMERA} for each in near]
    for changed, times, more in ((frames, ALIKE_CAMERA, NEAR_CAMERA), (lights, ALIKE, NEAR_SCORE)):
        guesses = [guess, *(guess | changes for changes in changed)]
        limit = case.score(guess)[0] * times + more
        alike = [each for each in guesses if case.score(each)[0] <= limit]
        odd = [case.score(each)[1] for each in alike]  # a name is preferred to a factor
        ranks = [(differences(each) + number, number) for each, number in zip(alike, odd, strict=True)]
        guess = alike[ranks.index(min(ranks))]
    return guess

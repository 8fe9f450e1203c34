"""Judging a guess by a large sample of pixels: what it explains, and which of its differences are needed for that."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from minirt.compare import lighting
from minirt.compare.cameras import CAMERA, differences
from minirt.compare.changed_shapes import Mask
from minirt.compare.geometry import see
from minirt.compare.lighting import Fit
from minirt.compare.search import GEOMETRIC, Case
from minirt.compare.sky import background
from minirt.compare.table import OURS, Guess

PIXELS = 40_000  # of the sample by which causes are judged
LEAST_GAIN = 0.001  # of inner pixels that a cause explains
MOST_LEFT = 0.5  # of the pixels that a cause changes may remain unexplained
CLEARLY = 4  # times as many pixels are explained only with a cause as only without it
IN_PLACE, LEAST_IN_PLACE = 0.9, 0.01  # shares of pixels that fit to their shapes, and that do so by a cause alone
LEAST_SEEN = 0.005  # share of pixels of a shape that tells the camera
LEAST_EDGES = 50  # pixels of the sample
MOST_INEXACT, MOST_AT_EDGES = 0.025, 0.05  # shares of inner pixels, and of those at edges, that a right guess leaves
EDGE_GAIN, EDGES_LEFT = 0.5, 0.3  # of the unexplained pixels at edges, and of all, a cause that moves edges may leave
TILTS = "horizontal", "not normalised", "too near"  # fields of view that differ little where the camera looks level
AIM = "yaw", "pitch"
TOGETHER = {"scale": ("scale", "fov"), "yaw": AIM, "pitch": AIM}  # parameters that are one cause


class Judge:
    """Judges a guess by a large sample of pixels."""

    def __init__(self, case: Case, guess: Guess, tolerance: float) -> None:
        self.case, self.guess, self.tolerance = case, guess, tolerance
        self.x, self.y, self.colours = case.sample(PIXELS)
        self.seen = case.see(guess, PIXELS)
        self.judged = case.judged[self.seen.owner]
        self.inner = self.judged & self.is_inner()
        self.fit = self.fitted(guess)
        sky = background(case.scene)[0]
        differ, drawn = (np.abs(each - sky).max(axis=-1) > tolerance for each in (self.colours, self.fit.shown))
        self.counted = self.inner & (differ | (self.seen.owner >= 0))  # background where it is expected is no evidence
        self.lit = self.counted & (differ | drawn)  # nor are shadows alone that are as dark as the background

    def is_inner(self) -> Mask:
        """Whether pixels are neither beside another face nor at the edge of a shadow."""
        inner, size = np.ones(len(self.x), bool), (self.case.width, self.case.height)
        plain = self.guess | {"reflections": False}
        for across, down in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            near = see(self.case.scene, size, self.x + across, self.y + down, plain)
            inner &= near.owner == self.seen.owner
            inner &= (near.open_to == self.seen.open_to).all(axis=0)
            inner &= np.abs(near.normal - self.seen.normal).max(axis=-1) < 0.5
        return inner

    def fitted(self, guess: Guess, fixed: str = "") -> Fit:
        """Return how a guess explains the inner pixels."""
        return self.case.fit(guess, PIXELS, self.inner, fixed)

    def even(self, guess: Guess) -> Mask:
        """Whether inner pixels fit to the others of their shapes, whatever their light."""
        unevenness = lighting.unevenness(self.case.see(guess, PIXELS), self.colours, guess)
        even: Mask = unevenness[self.lit] < (lighting.STEADY / 2) ** 2
        return even

    def sees_enough(self) -> bool:
        """Whether enough shapes are seen for the differences of the camera: one shape fits to many cameras."""
        shapes = np.bincount(self.seen.owner + 1, self.lit)[1:] > LEAST_SEEN * len(self.x)
        camera = OURS | {name: self.guess[name] for name in CAMERA}
        return differences(camera) <= int(np.count_nonzero(shapes)) + 1

    def left(self, fit: Fit, tolerance: float) -> float:
        """The share of inner pixels that a fit does not explain to a tolerance."""
        off = fit.error > tolerance
        return max(float(off[mask].mean()) if mask.any() else 1.0 for mask in (self.counted, self.lit))

    def is_right(self, exact: float) -> bool:
        """Whether a guess leaves as little as a right one: few inner pixels that are not exact, and few at edges.

        A wrong cause may explain the levels of nearly all pixels within the tolerance, but bends their light by more
        than rounding does, or moves edges.
        """
        edges = self.judged & ~self.inner
        off = self.fit.error[edges] > self.tolerance
        return self.left(self.fit, exact) <= MOST_INEXACT and int(off.sum()) <= MOST_AT_EDGES * len(off)

    def gain(self, without: Fit) -> float:
        """The share of inner pixels that are explained only with a cause.

        0 if nearly as many are only without it, if it changes hardly any by more than the tolerance, or if most of
        those are not explained: something like it is true then.
        """
        apart = np.abs(self.fit.shown - without.shown).max(axis=-1) > self.tolerance
        counted = self.counted | (self.inner & apart)  # background is evidence where something else is expected
        moved = counted & apart
        if moved.sum() <= LEAST_GAIN * counted.sum() or (self.fit.error[moved] > self.tolerance).mean() > MOST_LEFT:
            return 0.0
        return gain(*(fit.error[counted] <= self.tolerance for fit in (self.fit, without)))


def gain(explained: Mask, before: Mask) -> float:
    """The share of pixels that are explained only now; 0 if nearly as many were so only before."""
    won, lost = float((explained & ~before).mean()), float((before & ~explained).mean())
    return won - lost if won > CLEARLY * lost else 0.0


def plainer(guess: Guess, names: Iterable[str]) -> dict[str, Guess]:
    """Return a guess without each of its differences among some parameters."""
    found = {}
    for name in names:
        if guess[name] != OURS[name]:
            found[name] = guess | {each: OURS[each] for each in TOGETHER.get(name, (name,))}
    return found


def needed(case: Case, guess: Guess, tolerance: float) -> Judge:
    """Leave out, one by one, what a guess explains nothing by; return the judge of the guess that remains.

    What has no difference instead may need no factor that is not this program's.
    """
    while True:
        judge = Judge(case, guess, tolerance)
        others = [each for name, each in plainer(guess, guess).items() if name != "pixel"]
        fits = [judge.fitted(each) for each in others]
        gains = [(judge.gain(fit), number) for number, fit in enumerate(fits) if fit.odd <= judge.fit.odd]
        if not gains or min(gains)[0] > LEAST_GAIN:
            return judge
        guess = others[min(gains)[1]]


def shapes_alone(judge: Judge) -> Guess:
    """Return what a guess says of camera and shapes, if that puts the shapes into their places; else nothing."""
    even = judge.even(judge.guess)
    if not len(even) or even.mean() < IN_PLACE or not judge.sees_enough():
        return OURS
    others = plainer(judge.guess, GEOMETRIC).items()
    return OURS | {name: judge.guess[name] for name, each in others if gain(even, judge.even(each)) > LEAST_IN_PLACE}


def at_edges(judge: Judge) -> Judge:
    """Return the judge of the guess that explains pixels at edges best, which tell small changes of the camera."""
    case, guess, edges = judge.case, judge.guess, judge.judged & ~judge.inner
    if edges.sum() < LEAST_EDGES:
        return judge

    def left(each: Guess) -> float:
        return float((case.fit(each, PIXELS, edges).error[edges] > judge.tolerance).mean())

    tilts = TILTS if guess["fov"] in TILTS and guess["scale"] == 1.0 else (guess["fov"],)
    best = min((guess | {"pixel": pixel, "fov": fov} for pixel in ("centre", "corner") for fov in tilts), key=left)
    return Judge(case, best, judge.tolerance) if left(best) < min(EDGE_GAIN * left(guess), EDGES_LEFT) else judge

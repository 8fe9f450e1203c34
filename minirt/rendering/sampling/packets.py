"""The packets of a picture in the making: their contrast classes, numbers of samples, and what error they leave.

Errors of few samples sit at edges of objects, shadows and textures, all of which show as contrast between neighbouring
pixels (Whitted, An improved illumination model for shaded display, 1980, takes more samples where neighbours differ).

Where n samples lie evenly in a pixel with an edge, the squared error is about c / n^1.5 (Mitchell, Consequences of
stratified sampling in graphics, 1996). To reach a sum of such errors at the least cost, the sum of n, each class of
packets with about as much contrast gets a number of samples in proportion to c^0.4.

c is the mean of the probes of a class and of some more that found what its contrast lets expect. So few probes suffice,
and none that met no edge says that there is none. How far the sum of all errors is right is told by a pilot: probes
that have the samples of the finished picture. Some are chosen in proportion to the error that they are expected to
have, some evenly, so that a class that was misjudged is found, too (Hesterberg, Weighted average importance sampling
and defensive mixture distributions, 1995). All packets get a share of what uniform sampling would need, since a few
whose first sample missed an edge can have most of the error.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import inf, sqrt

import numpy as np

from minirt.kernel import functions
from minirt.kernel.machine_code.library import Call
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.frame import COUNTS, random_numbers
from minirt.rendering.outcome import ERROR_EXPONENT
from minirt.rendering.threads import Run
from minirt.rendering.tone_mapping import PLAIN, rounding_error, tone_named

CLASSES = 9  # class k > 0 differs by at least 2^(k - 1) levels of 255, but by less than 2^k; class 0 not at all
CLASS_OF = np.array([value.bit_length() for value in range(256)], np.uint8)
EDGE = 4  # the class from which on neighbours are taken to differ by an edge: by 8 levels


def contrast_classes(pixels: np.ndarray, packet_width: int, run: Run) -> np.ndarray:
    """Return the class of each packet, uint8 (rows, columns), by the greatest difference of a channel of its pixels
    from a neighbour above, below, left or right.

    `pixels` is C-contiguous uint8 (h, w, 4), all equally opaque; `run` runs a job on all threads.
    """
    below, beside = -pixels.shape[0] % PACKET_HEIGHT, -pixels.shape[1] % packet_width
    if below or beside:
        pixels = np.pad(pixels, ((0, below), (0, beside), (0, 0)), "edge")
    lines = pixels.reshape(len(pixels), -1)
    classes = np.empty((len(lines) // PACKET_HEIGHT, pixels.shape[1] // packet_width), np.uint8)
    counter = np.zeros(1, np.int64)

    def job() -> None:
        seen = np.empty((2, lines.shape[1]), np.uint8)
        functions.classify(counter, lines, seen, seen.view(np.uint64), CLASS_OF, classes)

    run(job)
    return classes


@cache
def classify_call() -> Call:
    numbers, none = np.zeros(1, np.int64), np.zeros((0, 0), np.uint8)
    return functions.classify.call(numbers, none, none, np.zeros((0, 0), np.uint64), CLASS_OF, none)


SQUARED_ROUNDING = 1 / 12  # mean squared error of rounding to whole levels
LINES = 64  # lines processed at once: their data fits a processor's cache, which takes two thirds of the time


def estimated_error(
    before: np.ndarray,
    after: np.ndarray,
    fewer: int,
    samples: int,
    is_wanted: Callable[[], bool] = lambda: True,
    tone: str = PLAIN,
) -> float | None:
    """Return the RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It has the error of `minirt.rendering.outcome` and that of rounding. Both pictures are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of their squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5. With another tone than plain the error is that of the light of the levels, clamped to
    [0, 1]. Return None as soon as `is_wanted` says no, which is asked a few times a millisecond.
    """
    total, rounding, light = 0.0, SQUARED_ROUNDING, np.minimum(tone_named(tone).light, 1.0)
    for top in range(0, len(before), LINES):
        if not is_wanted():
            return None
        a, b = before[top : top + LINES], after[top : top + LINES]
        if tone == PLAIN:
            difference = np.maximum(a, b) - np.minimum(a, b)
            total += int(np.square(difference, dtype=np.uint16).sum(dtype=np.int64))
        else:
            total += float(np.square(light.take(a[..., :3]) - light.take(b[..., :3])).sum()) * 255**2
            error = (255 * rounding_error(b, tone, dither=False)) ** 2
            rounding += (error - rounding) * len(b) / (top + len(b))
    ratio = (samples / fewer) ** ERROR_EXPONENT
    return sqrt(total / (before.size * 3 / 4) / (1 + ratio) + rounding) / 255


# Measured on scenes drawn at random: c grows about threefold from class to class.
EXPECTED = 3.0 ** np.arange(1 - CLASSES, 1)  # ratios of c, to that of the highest class
EDGE_ERROR = 0.04  # c of the highest class, for each pixel of a packet; about the upper quartile
LEAST_PROBES, MOST_PROBES = 4, 1000  # in a sweep
PRIOR = 4.0  # probes that what is expected counts as: c of a class, or the sum of the errors of a pilot
SPREAD = 2.5  # standard deviation of the error of a packet by what is expected of it, at least
CERTAINTY = 2.0  # standard errors of the estimate that are added to it
EVENLY = 0.6  # share of the pilot that is chosen evenly
LEAST_SHARE = 1 / 4  # of what uniform samples would be, for each packet
LEAST = 1e-12  # of a class as a share of the greatest
NEAR = 2  # classes by which a packet may be below its neighbours
SEARCHES, PRICES = 2, 64  # for the price of an error: so many times among so many prices


def allocate(c: np.ndarray, sizes: np.ndarray, error: float, budget: float, least: float) -> np.ndarray:
    """Return the numbers of samples for the packets of each class, `least` or more and not whole, that leave `error` as
    the sum of squared errors; or, if those cost more than the budget, the most that the budget pays for.

    `c` of the head of this module and `sizes`, the numbers of packets, are those of the classes, (CLASSES,). `budget`
    is in samples of packets beyond the first sweep. All packets have a sample, so that a class that gets no more costs
    nothing.
    """
    value = np.where(sizes > 0, c, 0.0)
    # At the lowest price the class with the most error gets one sample, at the highest that with the least gets all.
    most = float(np.log2(COUNTS[-1]) * (ERROR_EXPONENT + 1))
    low, high = float(-np.log2(value.max())), most - float(np.log2(np.maximum(value, LEAST * value.max()).min()))
    for _ in range(SEARCHES):
        prices = np.linspace(low, high, PRICES)
        new = at_price(prices[:, None], value, least)
        is_too_much = cost(new, sizes) > budget
        is_enough = is_too_much | (new**-ERROR_EXPONENT @ (sizes * c) <= error)
        first = int(is_enough.argmax()) if is_enough.any() else PRICES - 1
        low, high = prices[max(first - 1, 0)], prices[first]
    return at_price(np.array(low if is_too_much[first] else high), value, least)


def at_price(price: np.ndarray, value: np.ndarray, least: float) -> np.ndarray:
    """The numbers of samples for classes at the logarithm of the price of error; `value` is c, 0 for no packets."""
    ideal = 2.0 ** ((price + np.log2(np.maximum(value, LEAST * value.max()))) / (ERROR_EXPONENT + 1))
    return np.clip(ideal, least, COUNTS[-1])


def cost(samples: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """The number of the samples of classes with so many packets beyond the first sweep. Of 1 to 2 samples some packets
    get 2, others none."""
    return np.where(samples < 2, 2 * np.log2(samples), samples) @ sizes


def with_neighbours(classes: np.ndarray) -> np.ndarray:
    """Raise classes (rows, columns) to those of the eight neighbours less `NEAR`: a neighbour's sample may have met a
    thin wire that only other samples of the packet meet."""
    padded = np.pad(classes, 1)
    beside = np.maximum.reduce([padded[:, :-2], padded[:, 1:-1], padded[:, 2:]])
    around = np.maximum.reduce([beside[:-2], beside[1:-1], beside[2:]])
    return np.maximum(classes, np.maximum(around, NEAR) - NEAR)


def places_of(samples: np.ndarray) -> np.ndarray:
    """Numbers of samples as fractional levels: a random number in [0, 1) is to be added before the fraction is cut."""
    return np.interp(np.log2(samples), np.log2(COUNTS), np.arange(len(COUNTS)))


class Packets:
    """The packets of a picture, counted from 0, row by row. All of them begin with one sample."""

    def __init__(self, height: int, width: int, packet_width: int) -> None:
        self.columns = -(-width // packet_width)
        self.count = -(-height // PACKET_HEIGHT) * self.columns
        self.random = random_numbers(self.count)
        self.levels, self.classes = np.zeros((2, self.count), np.uint8)
        self.sizes = np.zeros(CLASSES, np.int64)  # of the classes
        self.c = EDGE_ERROR * PACKET_HEIGHT * packet_width * EXPECTED
        self.doubt = 0.0  # standard error of the estimated sum of squared errors, as a share of it

    def choose(self, number: float, chances: np.ndarray | None = None) -> np.ndarray:
        """Choose about so many packets at random for probes, evenly or in proportion to the chances of classes: one of
        each run of packets whose chances have the same sum."""
        number = min(max(round(number), LEAST_PROBES), MOST_PROBES, self.count)
        places = (np.arange(number) + self.random[:number]) / number
        if chances is None:
            return (places * self.count).astype(np.int64)
        ends = np.cumsum(chances[self.classes])
        return np.unique(np.searchsorted(ends, places * ends[-1], "right"))

    def learn(self, contrasts: np.ndarray, probes: np.ndarray, errors: np.ndarray) -> None:
        """Sort the packets, of which all have one sample, into classes by their contrasts (rows, columns) and those of
        their neighbours; estimate c of the classes from probes."""
        self.classes = with_neighbours(contrasts).ravel()
        sizes = self.sizes = np.bincount(self.classes, minlength=CLASSES)
        number = np.bincount(self.classes[probes], minlength=CLASSES) + PRIOR
        found = np.bincount(self.classes[probes], errors, CLASSES) + PRIOR * self.c
        self.c = np.maximum(found / number, self.c / number)  # products of differences may be negative
        self.doubt = SPREAD * float(np.linalg.norm(sizes * self.c / np.sqrt(number)) / (sizes @ self.c))

    def plan(self, goal: float, budget: float = inf) -> np.ndarray:
        """The numbers of samples of the classes that leave the squared error `goal`, in doubt included, or cost no more
        than a budget."""
        goal, whole = goal / (1 + CERTAINTY * self.doubt), float(self.sizes @ self.c)
        uniform = (whole / goal) ** (1 / ERROR_EXPONENT) if goal else inf  # what all packets would need
        if uniform <= 1:
            return np.ones(CLASSES)
        least = max(LEAST_SHARE * min(uniform, COUNTS[-1], budget / self.count), 1.0)
        return allocate(self.c, self.sizes, goal, budget, least)

    def bound(self, samples: np.ndarray) -> float:
        """The most that the sum of squared errors may be with so many samples for each class."""
        return float((self.sizes * self.c) @ samples**-ERROR_EXPONENT) * (1 + CERTAINTY * self.doubt)

    def chances(self, samples: np.ndarray) -> np.ndarray:
        """The chance of a packet of each class to be the next in a pilot, with so many samples for each class."""
        expected = self.c * samples**-ERROR_EXPONENT
        return (1 - EVENLY) * expected / (self.sizes @ expected) + EVENLY / self.count

    def correct(self, samples: np.ndarray, probes: np.ndarray, errors: np.ndarray) -> None:
        """Multiply c of all classes by what a pilot with so many samples for each class found, as a multiple of what
        was expected."""
        classes = self.classes[probes]
        weights = 1 / self.chances(samples)[classes]
        found = weights * errors
        expected = weights * self.c[classes] * COUNTS[self.levels[probes]] ** -ERROR_EXPONENT
        total = float(expected.sum())
        number = total**2 / float(expected @ expected)  # of probes that would tell as much by equal weights (Kish 1965)
        ratio = max((number * float(found.sum()) / total + PRIOR) / (number + PRIOR), 1 / PRIOR)
        self.doubt = max(SPREAD / sqrt(number + PRIOR), float(np.linalg.norm(found / ratio - expected)) / total)
        self.c = self.c * ratio

    def wanted(self, samples: np.ndarray) -> np.ndarray:
        """The levels of all packets that have so many samples for each class on average."""
        return (places_of(samples)[self.classes] + self.random).astype(np.uint8)

    def outcome(self) -> tuple[float, int, float]:
        """The average number of samples of a packet, the greatest, and the sum of squared errors with its standard
        error."""
        found = np.bincount(self.levels * np.int64(CLASSES) + self.classes, minlength=len(COUNTS) * CLASSES)
        found = found.reshape(-1, CLASSES)  # packets of each level and class
        mean = float(COUNTS @ found.sum(axis=1)) / self.count
        return mean, int(COUNTS[self.levels.max()]), float(COUNTS**-ERROR_EXPONENT @ found @ self.c) * (1 + self.doubt)

"""The packets of a picture in the making: their contrast classes, numbers of samples, errors, and what more they need.

Errors of few samples sit at edges of objects, shadows and textures, all of which show as contrast between neighbouring
pixels (Whitted, An improved illumination model for shaded display, 1980, takes more samples where neighbours differ).

Where n samples lie evenly in a pixel with an edge, the squared error is about c / n^1.5 (Mitchell, Consequences of
stratified sampling in graphics, 1996). To reach a sum of such errors at the least cost, the sum of n, each packet gets
a number of samples in proportion to c^0.4.

c is the mean of the probes of all packets of a class, those with about as much contrast. A class of which few were
probed may have missed something, so that some probes as one expects from the other classes, in proportion to the
square of the contrast, are counted with its own. And since all samples of a picture may have missed something, one
sample more than they are counts as if it differed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from math import sqrt

import numpy as np

from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.library import Call
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.frame import COUNTS, random_numbers
from minirt.rendering.outcome import ERROR_EXPONENT
from minirt.rendering.packing.camera import GOLDEN_RATIO
from minirt.rendering.threads import Job
from minirt.rendering.tone_mapping import PLAIN, rounding_error, tone_named

CLASSES = 9  # class k > 0 differs by at least 2^(k - 1) levels of 255, but by less than 2^k; class 0 not at all
CLASS_OF = np.array([value.bit_length() for value in range(256)], np.uint8)
EDGE = 4  # the class from which on neighbours are taken to differ by an edge: by 8 levels


def contrast_classes(
    pixels: np.ndarray, packet_width: int, run: Callable[[list[Job]], object], threads: int
) -> tuple[np.ndarray, np.ndarray]:
    """The class of each packet, uint8 (rows, columns), by the greatest difference of a colour from a neighbour above,
    below, left or right; and the number of packets of each class. `pixels` is C-contiguous uint8 (h, w, 4), all equally
    opaque; `run` runs jobs, one for each of the threads, side by side."""
    height, width, _ = pixels.shape
    beyond = -height % PACKET_HEIGHT, -width % packet_width
    if any(beyond):
        pixels = np.pad(pixels, ((0, beyond[0]), (0, beyond[1]), (0, 0)), "edge")
    lines = pixels.reshape(len(pixels), -1)
    classes = np.empty((len(lines) // PACKET_HEIGHT, pixels.shape[1] // packet_width), np.uint8)
    counter, counts = np.zeros(1, np.int64), np.zeros((threads, CLASSES), np.int64)

    def job(thread: int) -> None:
        seen = np.empty((2, lines.shape[1]), np.uint8)
        functions.classify(counter, lines, seen, seen.view(np.uint64), CLASS_OF, classes, counts[thread])

    run([partial(job, thread) for thread in range(threads)])
    return classes, counts.sum(axis=0)


@cache
def classify_call() -> Call:
    """The call of the compiled function, to look for its kernel."""
    numbers, none = np.zeros(1, np.int64), np.zeros((0, 0), np.uint8)
    return functions.classify.call(numbers, none, none, np.zeros((0, 0), np.uint64), CLASS_OF, none, numbers)


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
    """The RMSE of a picture `after` with `samples`, given the picture `before` with `fewer`.

    It is the error of `minirt.rendering.outcome` and that of rounding. Both are uint8 (h, w, 4), equally
    opaque. Their squared difference is the sum of both squared errors, whose ratio is that of the numbers of
    samples to the power of -1.5. With another tone than plain the error is that of the light of the levels, clamped to
    [0, 1]. None as soon as `is_wanted` says no, which is asked a few times a millisecond.
    """
    total, light = 0.0, np.minimum(tone_named(tone).light, 1.0)
    for top in range(0, len(before), LINES):
        if not is_wanted():
            return None
        a, b = before[top : top + LINES], after[top : top + LINES]
        if tone == PLAIN:
            difference = np.maximum(a, b) - np.minimum(a, b)
            total += int(np.square(difference, dtype=np.uint16).sum(dtype=np.int64))
        else:
            total += float(np.square(light.take(a[..., :3]) - light.take(b[..., :3])).sum()) * 255**2
    ratio = (samples / fewer) ** ERROR_EXPONENT
    rounding = SQUARED_ROUNDING if tone == PLAIN else (255 * rounding_error(after, tone, dither=False)) ** 2
    return sqrt(total / (before.size * 3 / 4) / (1 + ratio) + rounding) / 255


# Squared error of a picture of which one sample differs from all others, by a quarter in one of three colours.
UNSEEN_ERROR = 1 / 16
PRIOR = 4.0  # probes that the expectation of a class counts as
EXPECTED = 4.0 ** np.arange(CLASSES)  # ratios of c
SEARCHES, PRICES = 3, 24  # for the price of an error: so many times among so many prices
LEAST = 1e-12  # c of a class as a share of the greatest, and the greatest c of a picture without any error


def coefficients(classes: np.ndarray, counts: np.ndarray, errors: np.ndarray) -> np.ndarray:
    """Estimate c of every class from probes: their classes, numbers of samples and squared errors."""
    found = errors * counts**ERROR_EXPONENT
    expected = EXPECTED * max(found.sum() / EXPECTED[classes].sum(), LEAST / EXPECTED[-1])
    total = np.bincount(classes, found, CLASSES) + PRIOR * expected
    c: np.ndarray = total / (np.bincount(classes, minlength=CLASSES) + PRIOR)
    positive: np.ndarray = np.maximum(c, LEAST * max(float(c.max()), LEAST))
    return positive


def allocate(c: np.ndarray, packets: np.ndarray, error: float, budget: float) -> np.ndarray:
    """The numbers of samples, not whole, for the packets of each class and level, which leave a sum of squared errors;
    or, if those cost more than the budget, in samples of a packet, the most that the budget pays for.

    `packets` (classes, levels) counts the packets. Those that get no more samples than they have cost nothing; the
    others are drawn anew.
    """
    group, level = np.nonzero(packets)
    number = packets[group, level]
    # At the lowest price the class with the most error gets one sample, at the highest that with the least gets all.
    low, high = float(-np.log2(c.max())), float(np.log2(COUNTS[-1]) * (ERROR_EXPONENT + 1) - np.log2(c.min()))
    for _ in range(SEARCHES):
        prices = np.linspace(low, high, PRICES)
        new = at_price(prices[:, None], c[group], COUNTS[level])
        is_too_much = np.where(new > COUNTS[level], new, 0.0) @ number > budget
        is_enough = is_too_much | (new**-ERROR_EXPONENT @ (number * c[group]) <= error)
        first = int(is_enough.argmax()) if is_enough.any() else PRICES - 1
        low, high = prices[max(first - 1, 0)], prices[first]
    return at_price(np.array(low if is_too_much[first] else high), c[:, None], COUNTS)


def at_price(price: np.ndarray, c: np.ndarray, now: np.ndarray) -> np.ndarray:
    """The numbers of samples for classes and for packets that have some now, at the logarithm of the price of error."""
    ideal = 2.0 ** ((price + np.log2(c)) / (ERROR_EXPONENT + 1))
    samples: np.ndarray = np.maximum(np.minimum(ideal, COUNTS[-1]), now)
    return samples


def squared_error(c: np.ndarray, packets: np.ndarray) -> float:
    """The sum of the squared errors of packets, which are counted by class and level."""
    return float((packets * c[:, None] * COUNTS**-ERROR_EXPONENT).sum())


def places_of(samples: np.ndarray) -> np.ndarray:
    """Numbers of samples as fractional levels: a random number in [0, 1) is to be added before the fraction is cut."""
    places: np.ndarray = np.interp(np.log2(samples), np.log2(COUNTS), np.arange(len(COUNTS)))
    return places


class Packets:
    """The packets of a picture, counted from 0, row by row. All of them begin in class 0, with one sample."""

    def __init__(self, height: int, width: int, packet_width: int) -> None:
        self.columns = -(-width // packet_width)
        self.count = -(-height // PACKET_HEIGHT) * self.columns
        self.random = random_numbers(self.count)
        self.turn = 0  # times that `dither` gave other numbers
        self.levels, self.classes = np.zeros((2, self.count), np.uint8)
        self.histogram = np.zeros((CLASSES, len(COUNTS)), np.int64)  # packets by class and level
        self.histogram[0, 0] = self.count
        self.probes = np.zeros(0, np.intp)  # packets whose error with the samples that they have is known
        self.errors = np.zeros(0)  # squared errors of the probes

    def classify(self, classes: np.ndarray, sizes: np.ndarray) -> None:
        """Sort all packets, of which none has more than one sample, into classes of these sizes."""
        self.classes = classes.ravel()
        self.histogram[:, 0] = sizes

    def members(self, wanted: int) -> np.ndarray:
        """The packets of a class."""
        return np.flatnonzero(self.classes == wanted)

    def some_of_each_class(self, numbers: np.ndarray) -> np.ndarray:
        """Choose packets evenly from each class, about so many, at random places."""
        parts = [np.zeros(0, np.intp)]
        for wanted, number in enumerate(np.ceil(numbers).astype(int).tolist()):
            if number:
                members = self.members(wanted)
                most = min(number, len(members))
                places = (np.arange(most) + self.random[:most]) * (len(members) / max(most, 1))
                parts.append(members[places.astype(np.intp)])
        return np.concatenate(parts)

    def count_some(self, packets: np.ndarray) -> np.ndarray:
        """Count some packets by class and level."""
        slots = self.classes[packets].astype(np.intp) * len(COUNTS) + self.levels[packets]
        counts: np.ndarray = np.bincount(slots, minlength=CLASSES * len(COUNTS)).reshape(CLASSES, -1)
        return counts

    def drawn(self, packets: np.ndarray, levels: np.ndarray) -> None:
        """Note that packets are drawn with new levels, after which they are no probes any more."""
        self.histogram -= self.count_some(packets)
        self.levels[packets] = levels
        self.histogram += self.count_some(packets)
        kept = ~np.isin(self.probes, packets)
        self.probes, self.errors = self.probes[kept], self.errors[kept]

    def probed(self, packets: np.ndarray, errors: np.ndarray) -> None:
        """Note that packets were probed, and their squared errors."""
        self.probes = np.concatenate([self.probes, packets])
        self.errors = np.concatenate([self.errors, errors])
        self.turn += 1

    @property
    def known(self) -> int:
        """The number of probes that have more than one sample."""
        return int(np.count_nonzero(self.levels[self.probes]))

    def dither(self, packets: np.ndarray, salt: int = 2**10) -> np.ndarray:
        """A random number in [0, 1) for each of some packets, another at each turn."""
        numbers = self.random[packets] * salt + self.turn * GOLDEN_RATIO
        dither: np.ndarray = numbers - np.floor(numbers)
        return dither

    def coefficients(self) -> np.ndarray:
        """Estimate c of every class from all probes, and from what no sample met: with n samples in all packets, these
        together have an error of `UNSEEN_ERROR` / n^2."""
        known = coefficients(self.classes[self.probes], COUNTS[self.levels[self.probes]], self.errors)
        samples = np.maximum(self.histogram @ COUNTS / np.maximum(self.histogram.sum(axis=1), 1), 1.0)
        found: np.ndarray = known + UNSEEN_ERROR * samples ** (ERROR_EXPONENT - 2) / self.count
        return found

    def total(self) -> float:
        """Estimate the sum of the squared errors of all packets."""
        return squared_error(self.coefficients(), self.histogram)

    @property
    def samples(self) -> tuple[float, int]:
        """The average number of samples of a packet, and the greatest."""
        packets = self.histogram.sum(axis=0)
        return float(packets @ COUNTS / self.count), int(COUNTS[packets > 0].max())

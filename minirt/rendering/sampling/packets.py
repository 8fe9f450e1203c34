"""The packets of a picture in the making: their contrast classes, numbers of samples, errors, and what more they need.

Where n samples lie evenly in a pixel with an edge, the squared error is about c / n^1.5 (Mitchell, Consequences of
stratified sampling in graphics, 1996). To reach a sum of such errors at the least cost, the sum of n, each packet gets
a number of samples in proportion to c^0.4.

c is the mean of the probes of all packets of a class, those with about as much contrast. A class of which few were
probed may have missed something, so that some probes as one expects from the other classes, in proportion to the
square of the contrast, are counted with its own. And since all samples of a picture may have missed something, one
sample more than they are counts as if it differed.
"""

from __future__ import annotations

import numpy as np

from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.outcome import ERROR_EXPONENT
from minirt.rendering.packing.camera import GOLDEN_RATIO
from minirt.rendering.sampling.contrast import CLASSES
from minirt.rendering.sampling.sample_table import COUNTS, random_numbers

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


def unseen(packets: np.ndarray) -> np.ndarray:
    """The part of c of every class that is due to what no sample met: with n samples in all packets, these together
    have an error of `UNSEEN_ERROR` / n^2. `packets` (classes, levels) counts the packets."""
    number = np.maximum(packets.sum(axis=1), 1)
    samples = np.maximum(packets @ COUNTS / number, 1.0)
    part: np.ndarray = UNSEEN_ERROR * samples ** (ERROR_EXPONENT - 2) / packets.sum()
    return part


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
        """Estimate c of every class from all probes."""
        probes = self.probes
        known = coefficients(self.classes[probes], COUNTS[self.levels[probes]], self.errors)
        found: np.ndarray = known + unseen(self.histogram)
        return found

    def total(self) -> float:
        """Estimate the sum of the squared errors of all packets."""
        return squared_error(self.coefficients(), self.histogram)

    @property
    def samples(self) -> tuple[float, int]:
        """The average number of samples of a packet, and the greatest."""
        packets = self.histogram.sum(axis=0)
        return float(packets @ COUNTS / self.count), int(COUNTS[packets > 0].max())

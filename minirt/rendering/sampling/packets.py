"""The packets of a picture in the making: their contrast classes, their numbers of samples, and the probes that tell
their errors."""

from __future__ import annotations

import numpy as np

from minirt.kernel.stored_light import PACKET_HEIGHT
from minirt.rendering.frame_arguments import GOLDEN_RATIO
from minirt.rendering.sampling.allocation import coefficients, squared_error, unseen
from minirt.rendering.sampling.contrast import CLASSES
from minirt.rendering.sampling.sample_table import COUNTS, random_numbers


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
        self.marks = np.zeros(self.count, bool)  # all False between calls
        self.members_of: dict[int, np.ndarray] = {}
        self.estimated: tuple[int, np.ndarray] | None = None  # the turn, and the coefficients then

    def classify(self, classes: np.ndarray, sizes: np.ndarray) -> None:
        """Sort all packets, of which none has more than one sample, into classes of these sizes."""
        self.classes = classes.ravel()
        self.histogram[:, 0] = sizes
        self.estimated = None
        self.members_of.clear()

    def members(self, wanted: int) -> np.ndarray:
        """The packets of a class."""
        if wanted not in self.members_of:
            self.members_of[wanted] = np.flatnonzero(self.classes == wanted)
        return self.members_of[wanted]

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
        self.marks[packets] = True
        kept = ~self.marks[self.probes]
        self.marks[packets] = False
        self.probes, self.errors = self.probes[kept], self.errors[kept]

    def probed(self, packets: np.ndarray, errors: np.ndarray) -> None:
        """Note that packets were probed, and their squared errors."""
        self.probes = np.concatenate([self.probes, packets])
        self.errors = np.concatenate([self.errors, errors])
        self.turn += 1

    def is_probe(self, packets: np.ndarray) -> np.ndarray:
        """Whether each of some packets is probed."""
        self.marks[self.probes] = True
        found: np.ndarray = self.marks[packets]
        self.marks[self.probes] = False
        return found

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
        if not self.estimated or self.estimated[0] != self.turn:
            probes = self.probes
            found = coefficients(self.classes[probes], COUNTS[self.levels[probes]], self.errors)
            self.estimated = self.turn, found + unseen(self.histogram)
        return self.estimated[1]

    def total(self) -> float:
        """Estimate the sum of the squared errors of all packets."""
        return squared_error(self.coefficients(), self.histogram)

    @property
    def samples(self) -> tuple[float, int]:
        """The average number of samples of a packet, and the greatest."""
        packets = self.histogram.sum(axis=0)
        return float(packets @ COUNTS / self.count), int(COUNTS[packets > 0].max())

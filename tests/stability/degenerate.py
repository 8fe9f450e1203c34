"""Degenerate rays of every kind of shape, generated from its special places, and the answers that are wrong.

    python -m tests.stability.degenerate [--rays 1000000] [--seed 1] [--mode arrays] [sphere cylinder ...]

Prints a line for each kind and a few of the wrong rays; the status is 1 if there are any. First all rays are judged in
numbers of 106 bits, then those that seem wrong in 60 digits.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from minirt.scene.writer import lines_of
from minirt.shapes import KINDS, Kind, Shape
from tests.shapes.execution_modes import Array, Intersect
from tests.stability.band import again, facts_of_many, right, surely_wrong
from tests.stability.execution_modes import MODES
from tests.stability.poses import pose
from tests.stability.snapping import snapped

EACH = 1024  # rays of a shape, whole packets of a kernel
SHOWN = 5  # wrong rays of a kind


class Wrong(NamedTuple):
    """A ray with a wrong answer."""

    shape: Shape
    origin: list[float]
    direction: list[float]
    t: float
    exact: float
    again: bool  # whether it is the hit of the surface from which the ray starts

    def __str__(self) -> str:
        reason = " (where it starts)" if self.again else ""
        line = " ".join(lines_of((self.shape,), 1))
        return f"t = {self.t!r}{reason}, not {self.exact!r}: {line} from {self.origin} along {self.direction}"


def groups(kind: Kind, seed: int, shapes: int, rays: int) -> Iterator[tuple[Shape, Array, Array]]:
    """Shapes of a kind in random poses, and for each its snapped rays."""
    random = np.random.default_rng(seed)
    for _ in range(shapes):
        shape = pose(kind, random)
        with np.errstate(all="ignore"):
            yield shape, *snapped(shape, random, rays)


def wrong(
    intersect: Intersect, shape: Shape, origins: Array, directions: Array, most: int | None = None
) -> list[Wrong]:
    """The rays whose answer is wrong; of those that seem wrong only so many are judged in 60 digits."""
    t = intersect([shape], origins[None], directions[None])[0]
    with np.errstate(all="ignore"):
        facts = facts_of_many(shape, origins, directions, t)
        seem = np.flatnonzero(~right(shape, directions, t, facts))[:most]
        if not seem.size:
            return []
        o, d, t = origins[seem], directions[seem], t[seem]
        sure, exact = surely_wrong(shape, o, d, t)
        start = again(shape, t, exact)
    return [
        Wrong(shape, o[i].tolist(), d[i].tolist(), float(t[i]), float(exact.exact[i]), bool(start[i]))
        for i in np.flatnonzero(sure)
    ]


def main() -> int:
    """Judge the rays that the command line asks for, and return whether some answers are wrong."""
    titles = [kind.element.title for kind in KINDS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=", ".join(titles))
    parser.add_argument("--rays", type=int, default=1_000_000, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mode", choices=MODES, default="arrays")
    chosen = parser.parse_args()
    if unknown := set(chosen.kinds) - set(titles):
        parser.error(f"no such kind: {', '.join(unknown)}")
    failed = 0
    for kind in KINDS:
        if kind.element.title in (chosen.kinds or titles):
            shapes = -(-chosen.rays // EACH)
            found = []
            for group in groups(kind, chosen.seed, shapes, EACH):
                found += wrong(MODES[chosen.mode][0], *group)
            start = sum(each.again for each in found)
            print(f"{kind.element.title}: {shapes * EACH} rays, {len(found)} wrong, {start} of them where a ray starts")
            others = [each for each in found if not each.again]
            for each in (*others[:SHOWN], *[each for each in found if each.again][:SHOWN]):
                print(f"    {each}")
            failed += bool(found)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())

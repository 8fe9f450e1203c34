"""Runs of shapes, as the pages of a scene hold them: which ones two scenes share, and where they differ."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, groupby, islice, takewhile
from typing import Any

import numpy as np

from minirt.scene.pages import Crowd
from minirt.shapes import Shape

JOINED = 32  # runs, at most


def joined(runs: Sequence[Any], start: int) -> Iterator[tuple[np.ndarray, Sequence[Shape]]]:
    """Yield runs and the indices of their shapes, from `start` on. Crowds that are packed in columns are joined: a
    million spheres are packed in half of the time."""
    for kind, alike in groupby(runs, lambda run: run.kind if isinstance(run, Crowd) and run.kind.columnar else None):
        while some := [*islice(alike, JOINED if kind else 1)]:
            run = some[0]
            if len(some) > 1:
                columns = {name: np.concatenate([each.columns[name] for each in some]) for name in run.columns}
                run = Crowd(run.kind, [*chain.from_iterable(each.sources for each in some)], columns)
            yield np.arange(start, start + len(run)), run
            start += len(run)


def groups_of(runs: Iterable[Sequence[Shape]], numbers: Mapping[type[Shape], int]) -> np.ndarray:
    """Return the group of each shape of some runs, (s,), from the `numbers` of the kinds' groups."""
    groups = [np.zeros(0, np.int64)]
    for run in runs:
        if isinstance(run, Crowd):
            groups.append(np.repeat(numbers[run.kind], len(run)))
        else:
            groups.append(np.fromiter(map(numbers.__getitem__, map(type, run)), np.int64, len(run)))
    return np.concatenate(groups)


def common(runs: Sequence[Sequence[Shape]], others: Sequence[Sequence[Shape]]) -> int:
    """Count the runs, from the first one on, that are the same objects."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] is pair[1], zip(runs, others, strict=False)))


def differing_shapes(
    old: Iterable[Sequence[Shape]], new: Iterable[Sequence[Shape]]
) -> Iterator[tuple[int, Shape, Shape]]:
    """Yield the indices at which runs of the same lengths hold different objects, the old ones and the new ones."""
    start = 0
    for before, after in zip(old, new, strict=True):
        if before is not after and before != after:  # identical objects compare equal at the speed of C
            yield from ((at, a, b) for at, (a, b) in enumerate(zip(before, after, strict=True), start) if a is not b)
        start += len(after)

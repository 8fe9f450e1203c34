"""The table of latencies: from a key to its picture while a picture is refined, and between pictures of a movement."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from minirt import load
from tests.bench.latency import measure
from tests.bench.table import aligned, figure
from tests.paths import SCENES

COMPARED = [SCENES / f"{name}.rt" for name in ("demo", "gallery-marbles", "gallery-rings")]
TITLES = {"taps": "from a key to its picture", "held": "while a key is held", "dragged": "while the pointer drags"}


class Row(NamedTuple):
    """Milliseconds of a kind of latency on a scene."""

    scene: str
    kind: str  # a key of TITLES
    median: float
    worst: float


def measured(paths: list[Path], width: int, height: int) -> Iterator[Row]:
    """Measure the latencies of scenes, without a window."""
    for path in paths:
        print(f"latency on {path.stem}", file=sys.stderr, flush=True)
        latency = measure(load(path), width, height)
        for kind in TITLES:
            times = [1e3 * seconds for seconds in getattr(latency, kind)]
            yield Row(path.stem, kind, median(times), max(times))


def table(rows: list[Row]) -> str:
    """Return a table with a row per kind and a column per scene: the median and the worst."""
    scenes = list(dict.fromkeys(row.scene for row in rows))
    cells = {(row.kind, row.scene): f"{figure(row.median)} {figure(row.worst):>6}" for row in rows}
    lines = [[title, *(cells[kind, scene] for scene in scenes)] for kind, title in TITLES.items()]
    return aligned([["ms, median and worst", *scenes], *lines])


def records(rows: list[Row]) -> list[dict[str, Any]]:
    """Return the table for a JSON file."""
    return [row._replace(median=round(row.median, 2), worst=round(row.worst, 2))._asdict() for row in rows]

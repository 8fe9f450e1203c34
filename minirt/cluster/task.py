"""Tasks and their results: what is sent to a worker, and what comes back."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from minirt.rendering.outcome import Outcome
from minirt.scene import Camera

Region = tuple[int, int, int, int]  # column, row, width and height in pixels

NOTHING: Mapping[str, bytes] = MappingProxyType({})


class Settings(NamedTuple):
    """Settings of a picture: those of `minirt.render`."""

    width: int
    height: int
    samples: int | Literal["auto"] = 1
    error: float | None = None
    time: float | None = None
    precision: Literal["double", "single"] = "double"
    depth: int | None = None
    dither: bool = False


class Task(NamedTuple):
    """A picture, or some of its rows, to be rendered by anyone."""

    version: str  # of the program: another one might draw other bits
    scene: str  # digest of the scene
    files: tuple[str, ...]  # digests of the files that it needs
    settings: Settings
    form: str  # of the result: see `minirt.cluster.worker.FORMS`
    camera: Camera | None = None  # in place of the scene's
    region: Region | None = None  # of the picture; None for all
    threads: int | None = None  # None: the worker's share of its machine
    sent: Mapping[str, bytes] = NOTHING  # contents, by digest, that the worker may lack

    @property
    def what(self) -> str:
        """The name of the task in messages."""
        return f"rows {self.region[1]} to {self.region[1] + self.region[3] - 1}" if self.region else "a picture"


class Missing(NamedTuple):
    """Answer of a worker that lacks contents."""

    digests: tuple[str, ...]


class Made(NamedTuple):
    """Answer of a worker that has rendered."""

    arrays: tuple[np.ndarray, ...]  # levels, and light if asked for
    strips: tuple[bytes, ...]  # or parts of a file
    reached: Outcome | None


Answer = Missing | Made


@cache
def version() -> str:
    """Return the version of the program and of the sources of its kernels."""
    import minirt
    from minirt.kernel.machine_code.fingerprint import V3, fingerprint_of

    return f"{minirt.__version__} {fingerprint_of(V3)}"

"""Resources of a program over a long run: memory, open files and threads, and whether they stay as they are."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import NamedTuple

MAX_GROWTH = 1.03  # ratio of memory at the end to memory after the warm-up
WARM_UP = 10  # parts, such as minutes, after which everything was used once; but at most half of the run
THIRD = 1 / 3  # share of the measurements after the warm-up whose first ones are compared with as many last ones


class Usage(NamedTuple):
    """Resources of a process."""

    memory: int  # bytes, resident
    files: int  # that are open
    threads: int

    @classmethod
    def of(cls, process: int | str = "self") -> Usage:
        """Return what a process uses now; by default this one."""
        folder = Path("/proc") / str(process)
        lines = (line.split() for line in (folder / "status").read_text(encoding="ascii").splitlines())
        fields = {words[0]: words[1] for words in lines if len(words) > 1}
        files = len(os.listdir(folder / "fd"))  # noqa: PTH208
        return cls(1024 * int(fields["VmRSS:"]), files, int(fields["Threads:"]))

    @classmethod
    def typical(cls, usages: list[Usage]) -> Usage:
        """Return the median of the memory, and the greatest numbers of files and threads: those of the compiler come
        and go."""
        memory, files, threads = zip(*usages, strict=True)
        return cls(int(median(memory)), max(files), max(threads))

    def __str__(self) -> str:
        return f"{self.memory / 1e6:.1f} MB, {self.files} files, {self.threads} threads"


class Record:
    """Measurements of a run that is divided into equal parts, such as minutes: one after each part."""

    def __init__(
        self, parts: int, measure: Callable[[], Usage], show: Callable[[str], object] = lambda _: None
    ) -> None:
        self.parts = parts
        self.measure = measure
        self.show = show
        self.usages: dict[int, Usage] = {}  # by the number of parts that were over

    def note(self, share: float) -> None:
        """Measure if another part is over after this share of the run."""
        part = int(share * self.parts)
        if part > max(self.usages, default=0):
            self.usages[part] = self.measure()
            self.show(f"{part}/{self.parts}: {self.usages[part]}")

    @property
    def ends(self) -> tuple[Usage, Usage]:
        """The usage after the warm-up and at the end."""
        settled = [usage for part, usage in self.usages.items() if part >= min(WARM_UP, self.parts / 2)]
        compared = max(1, round(THIRD * len(settled)))
        return Usage.typical(settled[:compared]), Usage.typical(settled[-compared:])

    @property
    def is_flat(self) -> bool:
        """Whether nothing has grown since the warm-up."""
        before, after = self.ends
        is_small = after.memory <= MAX_GROWTH * before.memory
        return is_small and after.files <= before.files and after.threads <= before.threads

    @property
    def verdict(self) -> str:
        """The change of the resources since the warm-up, in words."""
        before, after = self.ends
        change = after.memory / before.memory - 1
        return f"{'flat' if self.is_flat else 'NOT FLAT'}: {before} -> {after} ({change:+.1%} memory)"

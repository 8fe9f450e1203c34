"""Splices: the difference between two versions of a scene, as a run of lines that others take the place of."""

from __future__ import annotations

from typing import NamedTuple

from minirt.scene import Item, Scene
from minirt.scene.writer import lines_of


class Splice(NamedTuple):
    """`removed` lines from line `start` on (counted from 0) are replaced by `lines`."""

    start: int
    removed: int
    lines: list[str]

    def apply(self, lines: list[str]) -> None:
        """Change the lines of a file. ValueError where it has fewer lines than the splice removes."""
        if not 0 <= self.start <= self.start + self.removed <= len(lines):
            raise ValueError("a change of lines that the file does not have")
        lines[self.start : self.start + self.removed] = self.lines


def difference(old: Scene, new: Scene) -> Splice | None:
    """Return the splice that makes the lines of `new` of those of `old`; None where they share all items.

    Versions of a scene share pages and items that did not change, so that only identities are compared.
    """
    old_pages, new_pages = old.pages, new.pages
    first = common_prefix(old_pages, new_pages)
    last = common_prefix(old_pages[first:][::-1], new_pages[first:][::-1])
    start = sum(len(page.items) for page in old_pages[:first])
    before = [item for page in old_pages[first : len(old_pages) - last] for item in page.items]
    after = [item for page in new_pages[first : len(new_pages) - last] for item in page.items]
    head = common_prefix(before, after)
    tail = common_prefix(before[head:][::-1], after[head:][::-1])
    removed, added = before[head : len(before) - tail], after[head : len(after) - tail]
    if not removed and not added:
        return None
    return Splice(start + head, len(removed), texts(added))


def common_prefix(first: tuple[object, ...] | list[Item], second: tuple[object, ...] | list[Item]) -> int:
    """Return the number of objects at the beginning of two sequences that are the same."""
    pairs = zip(first, second, strict=False)
    return next((n for n, (one, other) in enumerate(pairs) if one is not other), min(len(first), len(second)))


def texts(items: list[Item]) -> list[str]:
    """Return the lines of items."""
    return list(lines_of(tuple(items), len(items)))

"""Copy-on-write pages of a scene's items: an edit copies one page and shares all others with the scene before it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from minirt.element import Element, positional_fields

Item = Element | str  # a str is a comment or blank line, as it stands in the file

Answer = TypeVar("Answer")

PAGE_LENGTH = 1024  # items of a new page; insertions make it at most twice as long


class Crowd(Sequence[Any]):
    """Elements of one kind without attributes, which are made when somebody asks for one of them."""

    def __init__(self, kind: type[Any], sources: list[str], columns: dict[str, np.ndarray]) -> None:
        """`sources` are their lines, and `columns` the numbers of their positional fields, (n, width), by name."""
        self.kind, self.sources, self.columns = kind, sources, columns

    @cached_property
    def elements(self) -> Any:
        fields: Any = positional_fields(self.kind)
        values = {field.name: field.values(self.columns[field.name]) for field in fields}
        return self.kind.of_columns(len(self), {"source": self.sources, **values})

    def some(self, indices: Any) -> Crowd:
        """Return a crowd of elements like some of these, which are in the same order; or this one, if they are all."""
        if len(indices) == len(self):
            return self
        sources = [self.sources[index] for index in indices]
        return Crowd(self.kind, sources, {name: column[indices] for name, column in self.columns.items()})

    def __len__(self) -> int:
        return len(self.sources)

    def __getitem__(self, index: Any) -> Any:
        return self.elements[index]


class Page:
    """Immutable run of consecutive items, which caches its answers to repeated queries."""

    def __init__(self, items: Sequence[Item]) -> None:
        self.items = items
        self.kinds = kinds_of(items)
        self._cache: dict[Callable[..., Any], Any] = {}

    def of(self, sort: type[Any]) -> Sequence[Any]:
        """Return the items that are instances of a type, subclasses included."""
        if sort not in self._cache:
            matching = {kind for kind in self.kinds if issubclass(kind, sort)}
            is_all, items = matching == self.kinds, self.items if matching else ()
            self._cache[sort] = items if is_all else tuple(item for item in items if type(item) in matching)
        found: Sequence[Any] = self._cache[sort]
        return found

    def cached(self, query: Callable[[Sequence[Item]], Answer]) -> Answer:
        """Return `query(items)`, computed once."""
        if query not in self._cache:
            self._cache[query] = query(self.items)
        answer: Answer = self._cache[query]
        return answer

    @property
    def is_made(self) -> bool:
        """Whether somebody may have an item of it."""
        return not isinstance(self.items, Crowd) or "elements" in vars(self.items)


def span_of_ids(items: Sequence[Item]) -> range:
    """Return a range of the identities of some items: those of items that are made together lie close together."""
    ids = list(map(id, items))
    return range(min(ids), max(ids) + 1)


def kinds_of(items: Sequence[Any]) -> frozenset[type[Any]]:
    """Return the types of some items."""
    return frozenset([items.kind] if isinstance(items, Crowd) else map(type, items))


def pages_of(runs: Iterable[Sequence[Item]]) -> Iterator[Page]:
    """Split runs of items into pages of at most `PAGE_LENGTH` items."""
    for run in runs:
        for start in range(0, len(run), PAGE_LENGTH):
            yield Page(run if isinstance(run, Crowd) else tuple(run[start : start + PAGE_LENGTH]))


def replace_item(page: Page, index: int, new: tuple[Item, ...]) -> Iterator[Page]:
    """Return a page with item `index` replaced by any number of items; several pages when it became too long."""
    items = (*page.items[:index], *new, *page.items[index + 1 :])
    return pages_of([items]) if len(items) > 2 * PAGE_LENGTH else iter([Page(items)] if items else [])

"""Copy-on-write pages of a scene's items: an edit copies one page and shares all others with the scene before it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from minirt.element import Element

Item = Element | str  # a str is a comment or blank line, as it stands in the file

Answer = TypeVar("Answer")

PAGE_LENGTH = 1024  # items of a new page; insertions make it at most twice as long


class Page:
    """Immutable run of consecutive items, which caches its answers to repeated queries."""

    def __init__(self, items: tuple[Item, ...]) -> None:
        self.items = items
        self.kinds = frozenset(map(type, items))
        self._cache: dict[Callable[..., Any], Any] = {}

    def of(self, sort: type[Any]) -> tuple[Any, ...]:
        """Return the items that are instances of a type, subclasses included."""
        if sort not in self._cache:
            matching = {kind for kind in self.kinds if issubclass(kind, sort)}
            found = (item for item in self.items if type(item) in matching) if matching else ()
            self._cache[sort] = self.items if matching == self.kinds else tuple(found)
        items: tuple[Any, ...] = self._cache[sort]
        return items

    def cached(self, query: Callable[[tuple[Item, ...]], Answer]) -> Answer:
        """Return `query(items)`, computed once."""
        if query not in self._cache:
            self._cache[query] = query(self.items)
        answer: Answer = self._cache[query]
        return answer


def span_of_ids(items: tuple[Item, ...]) -> range:
    """Return a range of the identities of some items: those of items that are made together lie close together."""
    ids = list(map(id, items))
    return range(min(ids), max(ids) + 1)


def split_into_pages(items: tuple[Item, ...]) -> Iterator[Page]:
    """Split items into pages of `PAGE_LENGTH` items."""
    return (Page(items[start : start + PAGE_LENGTH]) for start in range(0, len(items), PAGE_LENGTH))


def replace_item(page: Page, index: int, new: tuple[Item, ...]) -> Iterator[Page]:
    """Return a page with item `index` replaced by any number of items; several pages when it became too long."""
    items = (*page.items[:index], *new, *page.items[index + 1 :])
    return split_into_pages(items) if len(items) > 2 * PAGE_LENGTH else iter([Page(items)] if items else [])

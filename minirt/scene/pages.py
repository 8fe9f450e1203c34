"""The items of a scene in pages: an edit makes one page anew, and shares all others with the scene that it changes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any, TypeVar

from minirt.element import Element

Item = Element | str  # a str is a line without an element, as it stands in the file

Answer = TypeVar("Answer")

PAGE_LENGTH = 1024  # of a page that was just made; inserting makes it at most twice as long


class Page:
    """Consecutive items, and what is asked of them again and again, worked out once."""

    def __init__(self, items: tuple[Item, ...]) -> None:
        self.items = items
        self._known: dict[Callable[..., Any], Any] = {}

    @cached_property
    def kinds(self) -> frozenset[type[Item]]:
        """The types of its items."""
        return frozenset(map(type, self.items))

    def of(self, sort: type[Any]) -> tuple[Any, ...]:
        """Its items of that type or of one that is derived from it."""
        if sort not in self._known:
            self._known[sort] = self._find(sort)
        found: tuple[Any, ...] = self._known[sort]
        return found

    def cached(self, question: Callable[[tuple[Item, ...]], Answer]) -> Answer:
        """What a function says of its items."""
        if question not in self._known:
            self._known[question] = question(self.items)
        answer: Answer = self._known[question]
        return answer

    def _find(self, sort: type[Any]) -> tuple[Any, ...]:
        fitting = {kind for kind in self.kinds if issubclass(kind, sort)}
        if fitting == self.kinds:
            return self.items
        return tuple(item for item in self.items if type(item) in fitting) if fitting else ()


def split_into_pages(items: tuple[Item, ...]) -> Iterator[Page]:
    """The items in pages of the usual length."""
    return (Page(items[start : start + PAGE_LENGTH]) for start in range(0, len(items), PAGE_LENGTH))


def replace_item(page: Page, at: int, instead: tuple[Item, ...]) -> Iterator[Page]:
    """The page, or the pages if it became too long, with other items in the place of the one at that index."""
    items = (*page.items[:at], *instead, *page.items[at + 1 :])
    return split_into_pages(items) if len(items) > 2 * PAGE_LENGTH else iter([Page(items)] if items else [])

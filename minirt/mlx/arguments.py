"""Arguments of MiniLibX's functions: integers, handles, images, and the options of the whole."""

from __future__ import annotations

import itertools
import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


Integer: TypeAlias = int | Any  # also an integer of ctypes or numpy
MaybeNone: TypeAlias = Any  # `Image | MaybeNone`: None after a failure, unless `Options.strict` is set


@dataclass
class Options:
    """The defaults are what the official wrapper does.

    alpha: images and pixels are blended by their alpha; False copies them and ignores it, as the C library does.
    strict: failures and exceptions of hooks raise; False reports them on standard error, and the program goes on.
    symbols: a key is reported as the symbol that it prints, Shift+1 as 33; False reports the symbol that it
        prints without modifiers, 49.
    application: name by which the desktop knows the windows (X11's WM_CLASS); empty for their first title.
    """

    alpha: bool = True
    strict: bool = False
    symbols: bool = False
    application: str = ""


def integer(value: Integer) -> int:
    """Convert an integer of Python, ctypes or numpy. Raises TypeError for anything else, such as 1.0."""
    return operator.index(getattr(value, "value", value))


_numbers = itertools.count(1 << 40, 64)  # as great as addresses: no colour and no position equals a handle


class Handle(int):
    """An object that is a number of its own, too: programs print handles, compare them and use them as keys."""

    def __new__(cls, *_arguments: object, **_named: object) -> Self:
        return super().__new__(cls, next(_numbers))


@dataclass(eq=False, repr=False)
class Image(Handle):
    """A picture to draw into: (h, w, 4) uint8, in memory blue, green, red, alpha."""

    pixels: NDArray[np.uint8]

    @property
    def width(self) -> int:
        return int(self.pixels.shape[1])

    @property
    def height(self) -> int:
        return int(self.pixels.shape[0])

"""Options: the choices in which a program may differ from the official wrapper."""

from __future__ import annotations

import operator
from typing import Any, TypeAlias

Integer: TypeAlias = int | Any  # also an integer of ctypes or numpy
MaybeNone: TypeAlias = Any  # `Image | MaybeNone`: None after a failure, unless `Options.strict` is set


class Options:
    """The defaults of Mlx are what the official wrapper does.

    alpha: images and pixels are blended by their alpha; False copies them and ignores it, as the C library does.
    strict: failures and exceptions of hooks raise; False reports them on standard error, and the program goes on.
    symbols: a key is reported as the symbol that it prints, Shift+1 as 33; False reports the symbol that it
        prints without modifiers, 49.
    application: name by which the desktop knows the windows (X11's WM_CLASS); empty for their first title.
    """

    def __init__(self, alpha: bool, strict: bool, symbols: bool) -> None:
        self.alpha = alpha
        self.strict = strict
        self.symbols = symbols
        self.application = ""


def integer(value: Integer) -> int:
    """Convert an integer of Python, ctypes or numpy. Raises TypeError for anything else, such as 1.0."""
    return operator.index(getattr(value, "value", value))

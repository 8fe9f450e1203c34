"""Options: the choices in which a program may differ from the official wrapper, and the base class that holds them."""

from __future__ import annotations

import operator
import sys
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from minirt.errors import MlxError
    from minirt.mlx.backend import Backend

Integer: TypeAlias = int | Any  # also an integer of ctypes or numpy
MaybeNone: TypeAlias = Any  # `Image | MaybeNone`: None after a failure, unless `Options.strict` is set


class Options:
    """The defaults of Mlx are what the official wrapper does.

    alpha: images and pixels are blended by their alpha; False copies them and ignores it, as the C library does.
    strict: failures and exceptions of hooks raise; False reports them on standard error, and the program goes on.
    symbols: a key is reported as the symbol that it prints, Shift+1 as 33; False reports the symbol that it
        prints without modifiers, 49.
    """

    def __init__(self, alpha: bool, strict: bool, symbols: bool) -> None:
        self.alpha = alpha
        self.strict = strict
        self.symbols = symbols


class Settings:
    """Base class of Mlx: its back end, its options and what happens on a failure.

    The attributes' names leave all others to programs, many of which derive their own class from Mlx.
    """

    def __init__(
        self, backend: Backend | None = None, *, alpha: bool = True, strict: bool = False, symbols: bool = False
    ) -> None:
        self._mlx_backend = backend
        self._mlx_options = Options(alpha, strict, symbols)

    def mlx_set_options(
        self, *, alpha: bool | None = None, strict: bool | None = None, symbols: bool | None = None
    ) -> int:
        """Change options, `alpha` for windows that are opened later; None leaves one as it is."""
        options = self._mlx_options
        options.alpha = options.alpha if alpha is None else alpha
        options.strict = options.strict if strict is None else strict
        options.symbols = options.symbols if symbols is None else symbols
        return 0

    def _mlx_failed(self, error: MlxError) -> MaybeNone:
        """Raise the error, or print it and return None, as MiniLibX does."""
        if self._mlx_options.strict:
            raise error
        print(f"mlx: {error}", file=sys.stderr)
        return None


def integer(value: Integer) -> int:
    """Convert an integer of Python, ctypes or numpy. Raises TypeError for anything else, such as 1.0."""
    return operator.index(getattr(value, "value", value))

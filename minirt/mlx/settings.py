"""Settings: base class of Mlx with its back end, its options and what happens on a failure."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from minirt.mlx.options import MaybeNone, Options

if TYPE_CHECKING:
    from minirt.errors import MlxError
    from minirt.mlx.backend import Backend


class Settings:
    """The attributes' names leave all others to programs, many of which derive their own class from Mlx."""

    def __init__(
        self, backend: Backend | None = None, *, alpha: bool = True, strict: bool = False, symbols: bool = False
    ) -> None:
        self._mlx_backend = backend
        self._mlx_options = Options(alpha, strict, symbols)

    def mlx_set_options(
        self,
        *,
        alpha: bool | None = None,
        strict: bool | None = None,
        symbols: bool | None = None,
        application: str | None = None,
    ) -> int:
        """Change options, `alpha` and `application` for windows that are opened later; None leaves one as it is."""
        options = self._mlx_options
        options.alpha = options.alpha if alpha is None else alpha
        options.strict = options.strict if strict is None else strict
        options.symbols = options.symbols if symbols is None else symbols
        options.application = options.application if application is None else application
        return 0

    def _mlx_failed(self, error: MlxError) -> MaybeNone:
        """Raise the error, or print it and return None, as MiniLibX does."""
        if self._mlx_options.strict:
            raise error
        print(f"mlx: {error}", file=sys.stderr)
        return None

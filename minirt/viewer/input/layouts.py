"""Layouts of keyboards. QWERTZ has the letters that matter where QWERTY has them."""

from __future__ import annotations

import locale
from typing import Final

LAYOUTS: Final = ("auto", "qwerty", "azerty", "qwertz")
FRENCH = ("fr_FR", "fr_BE", "French_France", "French_Belgium")  # locales where AZERTY is usual


def detect(layout: str) -> str:
    """The layout that `auto` means here; any other is itself."""
    if layout != "auto":
        return layout
    return "azerty" if locale.getlocale()[0] in FRENCH else "qwerty"

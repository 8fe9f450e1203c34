"""Keyboard layouts. On QWERTZ all letters of the bindings are where QWERTY has them."""

from __future__ import annotations

import locale
from typing import Final

LAYOUTS: Final = ("auto", "qwerty", "azerty", "qwertz")
AZERTY_LOCALES = ("fr_FR", "fr_BE", "French_France", "French_Belgium")  # locales whose usual keyboard is AZERTY


def resolve_layout(layout: str) -> str:
    """Replace `auto` by the layout of the user's locale; other layouts stay."""
    if layout != "auto":
        return layout
    return "azerty" if locale.getlocale()[0] in AZERTY_LOCALES else "qwerty"

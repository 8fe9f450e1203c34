"""The table of bindings as text: for the terminal, for the help in the window, for the README."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from minirt.viewer.bindings import BINDINGS, FINE, Binding
from minirt.viewer.chords import shown
from minirt.viewer.keymap import detect, spellings

Group = tuple[str, list[tuple[str, str]]]  # title, rows of keys and help


def groups(layout: str) -> Iterator[Group]:
    """The rows of the table with the keys of a layout."""
    for title, rows in groupby(BINDINGS, key=lambda binding: binding.group):
        yield title, [(keys_of(binding, layout), binding.help) for binding in rows]


def keys_of(binding: Binding, layout: str) -> str:
    """`Ctrl+Shift+Z  Ctrl+Y`"""
    return "  ".join(map(shown, spellings(binding, layout)))


def keys_text(layout: str = "auto") -> str:
    """What `--list-keys` prints."""
    listed = [*groups(detect(layout)), ("", [FINE])]
    width = max(len(keys) for _, rows in listed for keys, _ in rows)
    lines = []
    for title, rows in listed:
        lines += ["", title] if title else [""]
        lines += [f"  {keys:{width}}  {help}" for keys, help in rows]
    return "\n".join(lines[1:]) + "\n"


def keys_markdown() -> str:
    """The README's table."""
    lines = ["| action | keys | AZERTY |", "|---|---|---|"]
    for binding in BINDINGS:
        azerty = f"`{binding.azerty}`" if binding.azerty else ""
        lines.append(f"| {binding.help} | {' '.join(f'`{key}`' for key in binding.keys)} | {azerty} |")
    lines.append(f"| {FINE[1]} | `{FINE[0]}` | |")
    return "\n".join(lines) + "\n"

"""The documentation of the format, made from the fields of the elements."""

from __future__ import annotations

from minirt.element import Element, fields_of, pattern
from minirt.fields import Field
from minirt.scene.registry import ELEMENTS


def format_table() -> str:
    """Every element that a scene file may hold, as a Markdown table."""
    return "\n".join(["| line | element | fields |", "|---|---|---|", *map(row, ELEMENTS.values()), ""])


def row(kind: type[Element]) -> str:
    """The line of one element."""
    return f"| `{pattern(kind)}` | {name(kind)} | {'<br>'.join(map(meaning, fields_of(kind)))} |"


def name(kind: type[Element]) -> str:
    """What the element is called, how many of it there may be and what else its line may begin with."""
    if kind.once:
        return f"{kind.title} ({'exactly one' if kind.required else 'at most one'})"
    return f"{kind.title} (also {', '.join(f'`{alias}`' for alias in kind.aliases)})" if kind.aliases else kind.title


def meaning(field: Field) -> str:
    """A field with its range, unit and default."""
    doc = "" if field.doc == field.name == field.notation else f" {field.doc},"
    limits = field.range if field.range.startswith(">") else f"in {field.range}"
    unit = f", unit: {field.unit}" if field.unit else ""
    left_out = f", {field.format(field.default)} when left out" if field.default is not None else ""
    return f"`{field.notation}`{doc} {limits}{unit}{left_out}"

"""The tables of the pages about the scene format, generated from the fields of the elements."""

from __future__ import annotations

from minirt.element import Element, fields_of, pattern
from minirt.fields import Field
from minirt.materials import Compound
from minirt.scene.registry import ELEMENTS


def format_table() -> str:
    """Return two Markdown tables: all elements of a scene file, and the attributes shared by all shapes."""
    shared = {field.name: field for kind in ELEMENTS.values() for field in fields_of(kind) if field.sort}
    elements = ["| line | element | fields |", "|---|---|---|", *map(element_row, ELEMENTS.values()), ""]
    attributes = ["| attribute | of | meaning |", "|---|---|---|", *map(attribute_row, shared.values()), ""]
    return "\n".join(elements + attributes)


def element_row(kind: type[Element]) -> str:
    """Return the table row of an element."""
    own = (field for field in fields_of(kind) if not field.sort)
    return f"| `{pattern(kind)}` | {name_and_count(kind)} | {'<br>'.join(map(field_entry, own))} |"


def attribute_row(field: Field) -> str:
    """Return the table row of a shared attribute."""
    parts = fields_of(field.record) if isinstance(field, Compound) else ()
    entries = (f"`{part.placeholder or part.notation}` {description(part)}" for part in parts)
    text = "<br>".join([description(field), *entries])
    alone = f", or `{field.keys[0]}` for `{field.keys[0]}:{field.bare}`" if field.bare else ""
    for kind in ELEMENTS.values():
        own = next((other for other in fields_of(kind) if other.name == field.name and other.bare != field.bare), None)
        alone += f" ({kind.plural}: `{field.keys[0]}:{own.bare}`)" if own else ""
    aliases = "; also " + ", ".join(f"`{alias}:`" for alias in field.aliases) if field.aliases else ""
    return f"| `{field.notation}`{alone}{aliases} | {field.sort} | {text} |"


def name_and_count(kind: type[Element]) -> str:
    """Return an element's name with how many a scene may have, or with the aliases of its identifier."""
    if kind.once:
        return f"{kind.title} ({'exactly one' if kind.required else 'at most one'})"
    return f"{kind.title} (also {', '.join(f'`{alias}`' for alias in kind.aliases)})" if kind.aliases else kind.title


def field_entry(field: Field) -> str:
    """Return a field's notation and description."""
    return f"`{field.notation}` {description(field)}"


def description(field: Field) -> str:
    """Return a field's meaning, range, unit and default."""
    limits = field.range if field.range.startswith(">") or not field.range else f"in {field.range}"
    unit = f"unit: {field.unit}" if field.unit else ""
    has_default = field.default is not None and field.default is not False
    left_out = f"{field.format(field.default)} when left out" if has_default else ""
    doc = "" if field.doc == field.name == field.notation else field.doc
    return ", ".join(filter(None, (doc, limits, unit, left_out)))

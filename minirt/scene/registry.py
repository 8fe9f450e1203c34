"""Registry of all elements that a scene file may hold, by identifier; what a misspelled one means; and their table."""

from __future__ import annotations

import re

from minirt.element import Element, fields_of, pattern
from minirt.errors import nearest
from minirt.fields import Field
from minirt.materials import Compound
from minirt.scene.elements import Ambient, Background, Camera, Resolution
from minirt.scene.lights import LAMPS
from minirt.shapes import ALL_KINDS

KNOWN: tuple[type[Element], ...] = (
    *(Resolution, Ambient, Background, Camera),
    *LAMPS,
    *(kind.element for kind in ALL_KINDS),
)

ELEMENTS = {element.code: element for element in KNOWN}

# By every identifier that a line may begin with, aliases included.
SPELLINGS = {**ELEMENTS, **{alias: element for element in KNOWN for alias in element.aliases}}

LOOKALIKES = str.maketrans("1I0", "llo")
GLUED = re.compile(r"([A-Za-z]++)[-+.0-9]")  # an identifier without a blank before the first number
NUMERIC = re.compile(r"[-+.,]*[0-9]")

# Prefixes of attribute keys in scenes of other programs: the key that is meant, where spelling does not tell it.
FOREIGN_KEYS = {
    "refl": "mirror",
    "refr": "glass",
    "ior": "glass",
    "trans": "glass",
    "shin": "specular",
    "phong": "specular",
    "tex": "texture",
    "xpm": "texture",
    "image": "texture",
    "height": "bump",
    "bump": "bump",
    "chess": "checker",
    "chequer": "checker",
    "atten": "fade",
}


def nearest_word(word: str, known: list[str]) -> str:
    """Return the entry of `known` with the most similar spelling, or '' when none is similar."""
    meant = word[:40].lower(), word[:40].translate(LOOKALIKES).lower()
    return next((entry for entry in known if entry.lower() in meant), "") or next(iter(nearest(word, known)), "")


def nearest_element(word: str) -> str:
    """Return the identifier that `word` may mean, a misspelled identifier or an element's name; or ''."""
    glued = GLUED.match(word)
    if glued and glued[1] in SPELLINGS:
        return SPELLINGS[glued[1]].code
    names = {name: kind.code for kind in ELEMENTS.values() for name in (kind.title, kind.plural)}
    return nearest_word(word, list(ELEMENTS)) or names.get(nearest_word(word, list(names)), "")


def nearest_key(word: str, known: list[str]) -> str:
    """Return the key of `known` that `word` may mean, or ''."""
    key = next((key for prefix, key in FOREIGN_KEYS.items() if word.lower().startswith(prefix)), "")
    return key if key in known else nearest_word(word, known)


def hint(word: str) -> str:
    """Return `, did you mean 'sp'?`, or '' without a suggestion."""
    return f", did you mean '{word}'?" if word else ""


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

"""Registry of all elements that a scene file may hold, by identifier; and what a misspelled one means."""

from __future__ import annotations

import re
from functools import lru_cache

from minirt.element import Element
from minirt.errors import hint, nearest, quoted
from minirt.scene.elements import LAMPS, Ambient, Background, Camera, FurtherCamera, Resolution
from minirt.scene.lines import Line, Log, Word
from minirt.shapes import ALL_KINDS

SHAPES = tuple(kind.element for kind in ALL_KINDS)
KNOWN: tuple[type[Element], ...] = (Resolution, Ambient, Background, Camera, FurtherCamera, *LAMPS, *SHAPES)

ELEMENTS = {element.code: element for element in KNOWN}

# By every identifier that a line may begin with, aliases included.
SPELLINGS = {**ELEMENTS, **{alias: element for element in KNOWN for alias in element.aliases}}

# Names that attributes had in earlier versions. Lines that have them are read, with a notice, by this version alone.
OLD_NAMES = {
    "spc": "specular",
    "mir": "mirror",
    "ref": "glass",
    "pat": "checker",
    "txm": "texture",
    "tx": "texture",
    "bum": "bump",
    "nm": "normal",
    "fade": "reach",
    **{name: f"pattern:{name}" for name in ("marble", "wood", "clouds")},
}

LOOKALIKES = str.maketrans("1I0", "llo")
GLUED = re.compile(r"([A-Za-z]++)[-+.0-9]")  # an identifier without a blank before the first number
NUMERIC = re.compile(r"[-+.,]*[0-9]")


def nearest_word(word: str, known: list[str]) -> str:
    """Return the entry of `known` with the most similar spelling, or '' when none is similar."""
    meant = word[:40].lower(), word[:40].translate(LOOKALIKES).lower()
    return next((entry for entry in known if entry.lower() in meant), "") or next(iter(nearest(word, known)), "")


@lru_cache(maxsize=1024)  # a file that is no scene has the same wrong word in each of its lines
def nearest_element(word: str) -> str:
    """Return the identifier that `word` may mean, a misspelled identifier or an element's name; or ''."""
    glued = GLUED.match(word)
    if glued and glued[1] in SPELLINGS:
        return SPELLINGS[glued[1]].code
    names = {name: kind.code for kind in ELEMENTS.values() for name in (kind.title, kind.plural)}
    return nearest_word(word, list(ELEMENTS)) or names.get(nearest_word(word, list(names)), "")


def identify(word: Word, line: Line, log: Log) -> type[Element] | None:
    """Return the kind of element whose identifier `word` is; None for no identifier: an error goes into the log."""
    code = word.text
    if code in SPELLINGS:
        return SPELLINGS[code]
    glued = GLUED.match(code)
    if glued and glued[1] in SPELLINGS:
        log.error(line, f"a blank is missing after '{glued[1]}'", word.column + len(glued[1]))
        return None
    message = f"unknown element {quoted(code)}{hint(nearest_element(code))}"
    if NUMERIC.match(code):
        message = f"a line begins with one of {', '.join(ELEMENTS)}, got {quoted(code)}"
    log.error(line, message, word.column, len(code))
    return None

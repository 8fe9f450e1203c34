"""What somebody may have meant by a wrong word."""

from __future__ import annotations

import difflib
import re

from minirt.scene.registry import ELEMENTS, SPELLINGS

LOOKALIKES = str.maketrans("1I0", "llo")
GLUED = re.compile(r"([A-Za-z]+)[-+.0-9]")
NUMERIC = re.compile(r"[-+.,]*[0-9]")

# How the keys of attributes begin in other programs' scenes, where their spelling does not tell what is meant.
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


def nearest(word: str, known: list[str]) -> str:
    """The entry of `known` that is spelled most like `word`, or nothing where none is near."""
    word = word[:40]
    for each in known:
        if each.lower() in (word.lower(), word.translate(LOOKALIKES).lower()):
            return each
    return next(iter(difflib.get_close_matches(word, known, n=1, cutoff=0.6)), "")


def nearest_element(word: str) -> str:
    """The identifier of the element that `word` may mean: an identifier misspelled, or the element's name."""
    glued = GLUED.match(word)
    if glued and glued[1] in SPELLINGS:
        return SPELLINGS[glued[1]].code
    names = {name: kind.code for kind in ELEMENTS.values() for name in (kind.title, kind.plural)}
    return nearest(word, list(ELEMENTS)) or names.get(nearest(word, list(names)), "")


def nearest_key(word: str, known: list[str]) -> str:
    """The key of `known` that `word` may mean, or nothing."""
    meant = next((key for start, key in FOREIGN_KEYS.items() if word.lower().startswith(start)), "")
    return meant if meant in known else nearest(word, known)


def hint(word: str) -> str:
    """`, did you mean 'sp'?` or nothing."""
    return f", did you mean '{word}'?" if word else ""

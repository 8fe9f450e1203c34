"""Suggestions for misspelled identifiers and keys: "did you mean 'sp'?"."""

from __future__ import annotations

import re

from minirt.scene.registry import ELEMENTS, SPELLINGS

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


def nearest(word: str, known: list[str]) -> str:
    """Return the entry of `known` with the most similar spelling, or '' when none is similar."""
    word = word[:40]
    for entry in known:
        if entry.lower() in (word.lower(), word.translate(LOOKALIKES).lower()):
            return entry
    import difflib

    return next(iter(difflib.get_close_matches(word, known, n=1, cutoff=0.6)), "")


def nearest_element(word: str) -> str:
    """Return the identifier that `word` may mean, a misspelled identifier or an element's name; or ''."""
    glued = GLUED.match(word)
    if glued and glued[1] in SPELLINGS:
        return SPELLINGS[glued[1]].code
    names = {name: kind.code for kind in ELEMENTS.values() for name in (kind.title, kind.plural)}
    return nearest(word, list(ELEMENTS)) or names.get(nearest(word, list(names)), "")


def nearest_key(word: str, known: list[str]) -> str:
    """Return the key of `known` that `word` may mean, or ''."""
    key = next((key for prefix, key in FOREIGN_KEYS.items() if word.lower().startswith(prefix)), "")
    return key if key in known else nearest(word, known)


def hint(word: str) -> str:
    """Return `, did you mean 'sp'?`, or '' without a suggestion."""
    return f", did you mean '{word}'?" if word else ""

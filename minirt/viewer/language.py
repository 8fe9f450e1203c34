"""Language of the window: its texts by a catalogue of gettext's form, `locale/LANGUAGE.po`.

The English texts are the catalogue's keys, with {} for what changes: "deleted {}". So texts are translated as a
whole where they are drawn, also errors of parts that know no language; what has no translation stays English.
"""

from __future__ import annotations

import ast
import locale
import os
import re
from contextlib import suppress
from functools import lru_cache
from unicodedata import normalize

from minirt.helpers import package

VARIABLES = "LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"  # of the environment, as gettext asks them
GAP = "    "  # between groups of words
LOCATION = re.compile(r"(.+?:\d+:\d+: )(.*)")  # of an error in a file
Patterns = list[tuple[re.Pattern[str], str]]


def language() -> str:
    """Return the code of the user's language, such as fr."""
    asked = next(filter(None, map(os.environ.get, VARIABLES)), None) or locale.getlocale()[0] or ""
    return asked.split(":")[0][:2].lower()


@lru_cache(maxsize=4)
def catalogue(code: str) -> tuple[dict[str, str], Patterns]:
    """Read the texts of a language, and those with {} as patterns, the longest first; none where there is no file."""
    texts = dict[str, str]()
    if code.isalpha():
        with suppress(OSError):
            texts = read_po(package.read(__name__, f"locale/{code}.po").decode())
    open_ended = sorted((text for text in texts if "{}" in text), key=len, reverse=True)
    patterns = [
        (re.compile("(.*?)".join(map(re.escape, text.split("{}"))), re.DOTALL), texts[text]) for text in open_ended
    ]
    return texts, patterns


def read_po(text: str) -> dict[str, str]:
    """Return the entries of a catalogue by their English texts; those without a translation are left out."""
    entries: list[list[str]] = []
    part = 0
    for keyword, quoted in re.findall(r'^(msgid|msgstr)?\s*(".*")$', text, re.MULTILINE):
        if keyword == "msgid":
            entries.append(["", ""])
        part = {"msgid": 0, "msgstr": 1}.get(keyword, part)
        entries[-1][part] += ast.literal_eval(quoted)
    return {english: other for english, other in entries if english and other}


def translated(text: str) -> str:
    """Return a text of the window in the user's language: line by line, and each group of words by itself."""
    code = language()
    if not catalogue(code)[0]:
        return text
    return "\n".join(GAP.join(phrase(group, code) for group in line.split(GAP)) for line in text.split("\n"))


def searchable(text: str) -> str:
    """Return a text in small letters without accents, as one types it to search for it."""
    return text.lower() if text.isascii() else normalize("NFD", text).encode("ascii", "ignore").decode().lower()


@lru_cache(maxsize=512)
def phrase(text: str, code: str) -> str:
    """Translate a phrase into the language `code`; what has no translation stays English.

    The first way that the catalogue knows is taken: as a whole, by a pattern, after the place in a file, or the longest
    beginning and then the rest by itself, as in "diameter must be > 0, got -3".
    """
    texts, patterns = catalogue(code)
    if text in texts or not text:
        return texts.get(text, text)
    for pattern, meaning in patterns:
        if found := pattern.fullmatch(text):
            return meaning.format(*(phrase(group, code) for group in found.groups()))
    if located := LOCATION.fullmatch(text):
        return located[1] + phrase(located[2], code)
    for blank in reversed([*re.finditer(":? ", text)]):
        if text[: blank.start()] in texts:
            return texts[text[: blank.start()]] + blank[0] + phrase(text[blank.end() :], code)
    return text

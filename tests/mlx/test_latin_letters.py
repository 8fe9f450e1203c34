"""Latin letters of keys: which letter a key stands for where its layout does not print it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from minirt.mlx.on_pyglet import x11
from minirt.mlx.on_pyglet.x11 import latin_letter

FIRST = 24, 38, 52  # key codes of the first keys of the three rows of letters
LAYOUTS = {  # what the keys print, in rows; - is any symbol that is no Latin letter
    "us": ("qwertyuiop[]", "asdfghjkl;'", "zxcvbnm,./"),
    "fr": ("azertyuiop^$", "qsdfghjklmù", "wxcvbn,;:!"),
    "bepo": ("bépoè^vdljzw", "auie,ctsrnm", "àyx.k'qghf"),
    "dvorak": ("',.pyfgcrl/=", "aoeuidhtns-", ";qjkxbmwvz"),
    "gr": (";ςερτυθιοπ[]", "ασδφγηξκλ-'", "ζχψωβνμ,./"),
    "ru": ("йцукенгшщзхъ", "фывапролджэ", "ячсмитьбю."),
}
FR_ON_KEYS = {24: "a", 25: "z", 38: "q", 52: "w"}  # letters of a French keyboard that an American one has elsewhere


def table(layout: str) -> dict[int, int]:
    """Return the symbols of the keys of a layout."""
    return {
        first + n: ord(symbol)
        for first, row in zip(FIRST, LAYOUTS[layout], strict=True)
        for n, symbol in enumerate(row)
    }


def letters(monkeypatch: pytest.MonkeyPatch, active: int, *layouts: str) -> dict[int, str | None]:
    """Return the letter that each key stands for, with some layouts of which one is active."""
    tables = [table(layout) for layout in layouts]
    found = lambda _, key, group: tables[group if group < len(tables) else 0].get(key, 0)  # noqa: E731
    monkeypatch.setattr(x11, "_symbol", found)
    events = {key: SimpleNamespace(xkey=SimpleNamespace(keycode=key, state=active << 13)) for key in table("us")}
    codes = {key: latin_letter(None, event) for key, event in events.items()}
    return {key: code and chr(code) for key, code in codes.items()}


@pytest.mark.parametrize("layout", ["us", "fr", "bepo", "dvorak"])
def test_keyboards_with_latin_letters_stay_as_they_are(monkeypatch, layout):
    assert set(letters(monkeypatch, 0, layout).values()) == {None}


@pytest.mark.parametrize("layout", ["gr", "ru"])
def test_other_keyboards_have_the_letters_of_an_american_one(monkeypatch, layout):
    american = {key: chr(code) if chr(code).isalpha() else None for key, code in table("us").items()}
    assert letters(monkeypatch, 0, layout) == american
    assert letters(monkeypatch, 1, "us", layout) == american


def test_the_letters_of_another_layout_of_the_user_come_first(monkeypatch):
    found = letters(monkeypatch, 1, "fr", "ru")
    assert {key: found[key] for key in FR_ON_KEYS} == FR_ON_KEYS
    assert set(letters(monkeypatch, 0, "fr", "ru").values()) == {None}

"""The window's texts in French: the catalogue is complete, and texts with numbers and names are translated whole."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.element import Record, fields_of
from minirt.materials import Compound
from minirt.scene.registry import ELEMENTS
from minirt.viewer import language
from minirt.viewer.app.menu import MENU
from minirt.viewer.bindings import BINDINGS, FINE_NOTE, key_groups
from minirt.viewer.display import tool_row
from minirt.viewer.display.screen import TIPS
from minirt.viewer.editing.values import part_names
from tests.paths import ROOT
from tests.viewer.fake import played

try:
    from minirt.viewer.panel.elements import TOOLS
    from minirt.viewer.panel.groups import GROUPS
except ImportError:  # no slimgui, so there is no panel
    TOOLS, GROUPS = {}, ()

# Functions whose texts the window shows.
SAYS = {
    "with_message",
    "say",
    "FieldError",
    "error",
    "FileError",
    "LookupError",
    "translated",
    "option",
    "whole",
    "hint",
}
PARTS = ("viewer", "fields", "materials", "scene")
CATALOGUES = ROOT / "minirt/viewer/locale"
AXIS = "a b.rt:5:10: sphère axe ne doit pas être 0,0,0 : cela n'indique aucune direction\net 2 de plus"
SAVED = "enregistré : /tmp/a sphere.rt ; ce qu'un autre programme avait écrit est dans b.rt"


def templates(node: ast.expr) -> list[str]:
    """Return the texts that an expression can be, with {} in place of what it inserts; none if it is no text."""
    match node:
        case ast.Constant(str() as text):
            return [text]
        case ast.JoinedStr(parts):
            return ["".join(each.value if isinstance(each, ast.Constant) else "{}" for each in parts)]  # type: ignore[misc]
        case ast.IfExp(_, yes, no):
            return templates(yes) + templates(no)
        case ast.BinOp(left, ast.Add(), right):
            return [before + after for before in templates(left) for after in templates(right)]
    return []


def messages(source: str) -> Iterator[str]:
    """Yield the texts that a module gives to a function of SAYS."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            for argument in node.args if name in SAYS else []:
                yield from (text for text in templates(argument) if any(map(str.isalpha, text.replace("{}", ""))))


def names() -> Iterator[str]:
    """Yield the names of all elements, values and parts of values."""
    kinds: list[type[Record]] = [*ELEMENTS.values()]
    for kind in kinds:
        yield getattr(kind, "title", "")
        for field in fields_of(kind):
            yield from (field.title, field.doc, *part_names(field))
            kinds += [field.record] if isinstance(field, Compound) and field.record not in kinds else []


def english() -> set[str]:
    """All texts of the window that the sources tell of."""
    files = (file for part in PARTS for file in (ROOT / "minirt" / part).rglob("*.py"))
    texts = {text for file in files for text in messages(file.read_text(encoding="utf-8"))}
    texts |= {each.help for each in BINDINGS} | {each.group for each in BINDINGS} | {FINE_NOTE[1]}
    texts |= {*MENU.values()} | {each.name for each in tool_row.TOOLS}
    texts |= {group for line in TIPS.split("\n") for group in line.split(language.GAP)}
    texts |= {*GROUPS, *TOOLS.values()}
    return texts | {name for name in names() if len(name) > 1}


@pytest.fixture
def french(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "fr_FR:en")


@pytest.mark.parametrize("file", sorted(CATALOGUES.glob("*.po")), ids=lambda file: file.stem)
def test_a_catalogue_is_complete_and_its_texts_insert_as_much_as_the_english_ones(file: Path) -> None:
    texts = language.read_po(file.read_text(encoding="utf-8"))
    assert sorted(english() - set(texts)) == [], "these have no translation"
    assert [text for text, meaning in texts.items() if text.count("{}") != meaning.count("{}")] == []


def test_a_text_that_lacks_a_translation_is_found() -> None:
    assert list(messages('state.with_message(f"no {x} to " + "see")')) == ["no {} to see"]
    assert list(messages('raise FieldError("a" if x else "b")')) == ["a", "b"]
    assert "no {} to see" not in english()


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("deleted sphere 1", "supprimé : sphère 1"),
        ("diameter must be > 0, got '-3'", "diamètre doit être > 0, et non '-3'"),
        ("a b.rt:5:10: sphere axis must not be 0,0,0: it points nowhere\nand 2 more", AXIS),
        ("sphere: + - diameter 3.8    H: help", "sphère: + - diamètre 3.8    H : aide"),
        ("saved: /tmp/a sphere.rt; what another program had written is in b.rt", SAVED),
        ("not a text of the catalogue", "not a text of the catalogue"),
        ("light of its own, which lights nothing else: glow:1", "lumière propre, qui n'éclaire rien d'autre: glow:1"),
        ("640x480 at 1/3    4 of 16 samples    error 0.003", "640x480 à 1/3    4 sur 16 échantillons    erreur 0.003"),
        ("", ""),
        ("{} }{", "{} }{"),
    ],
)
def test_texts_are_translated_whole_with_what_they_insert(french: None, text: str, meaning: str) -> None:
    assert language.translated(text) == meaning


@pytest.mark.parametrize("value", ["C", "en_GB.UTF-8", "xx_YY", "../fr", "e", "POSIX"])
def test_other_languages_stay_english(monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    monkeypatch.setenv("LANGUAGE", "")
    monkeypatch.setenv("LC_ALL", value)
    assert language.translated("deleted sphere 1") == "deleted sphere 1"
    monkeypatch.setenv("LC_ALL", "fr_FR.UTF-8")
    assert language.translated("deleted sphere 1") == "supprimé : sphère 1"


def test_the_window_draws_its_texts_in_french_and_searches_them(french: None, monkeypatch: pytest.MonkeyPatch) -> None:
    cone = played("press N", "press c", "press o", "press n", "press e")
    assert cone.state.element.title == "cone"
    assert cone.screen.list_box is not None
    assert cone.screen.list_box.rows[0] == "cône"
    lines = ("press Tab", "press Delete"), ("press h",), ("press N",), ("press Tab", "text 7"), ("press I",)
    frames = [played(*each).screen.frame.copy() for each in lines]
    assert next(key_groups("qwerty", "lumiere", language.translated))[1] == [("L", "sélectionner la lumière suivante")]
    monkeypatch.setenv("LANGUAGE", "en")
    for each, frame in zip(lines, frames, strict=True):
        assert (played(*each).screen.frame != frame).any(), each

"""The window's texts in French: the catalogue has or lists each, and inserts numbers and names into whole texts."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.viewer import language
from minirt.viewer.bindings import key_groups
from tests.viewer.english import CATALOGUES, MISSING, english, messages, with_missing
from tests.viewer.fake import played

AXIS = "a b.rt:5:10: sphère axe ne doit pas être 0,0,0 : cela n'indique aucune direction\net 2 de plus"
SAVED = "enregistré : /tmp/a sphere.rt ; ce qu'un autre programme avait écrit est dans b.rt"


@pytest.fixture
def french(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LANGUAGE", "fr_FR:en")


@pytest.mark.parametrize("file", sorted(CATALOGUES.glob("*.po")), ids=lambda file: file.stem)
def test_a_catalogue_has_or_lists_each_text_and_inserts_as_much_as_the_english_ones(file: Path) -> None:
    catalogue = file.read_text(encoding="utf-8")
    assert with_missing(catalogue) == catalogue, "python -m tests.make_tables lists what has no translation"
    texts = language.read_po(catalogue)
    assert [text for text, meaning in texts.items() if text.count("{}") != meaning.count("{}")] == []


def test_a_text_without_a_translation_is_listed_and_stays_english() -> None:
    complete = (CATALOGUES / "fr.po").read_text(encoding="utf-8").partition(MISSING)[0]
    torus = '\nmsgid "torus"\nmsgstr "tore"\n'
    assert torus in complete
    listed = with_missing(complete.replace(torus, ""))
    assert '\nmsgid "torus"\nmsgstr ""\n' in listed.partition(MISSING)[2]
    assert "torus" not in language.read_po(listed)
    assert with_missing(listed) == listed
    assert 'msgid "torus"\nmsgstr ""' not in with_missing(listed.replace(MISSING, torus + MISSING))


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

"""The table of bindings, and the texts and keymaps that are made from it."""

from __future__ import annotations

from collections import Counter

import pytest

from minirt.mlx import Button, Key, Modifier
from minirt.viewer.app.commands import COMMANDS
from minirt.viewer.app.panels import TYPE
from minirt.viewer.bindings import (
    BINDINGS,
    LAYOUTS,
    Chord,
    Keymap,
    chords_of,
    keys_markdown,
    keys_text,
    parse_chord,
    platform_spelling,
    resolve_layout,
)
from minirt.viewer.editing.dragging import DRAGS
from minirt.viewer.editing.editor import EDITS

ACTIONS = [binding.action for binding in BINDINGS]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_no_key_is_bound_twice(layout):
    counts = Counter(each for binding in BINDINGS for each in chords_of(binding, layout))
    assert [each for each, count in counts.items() if count > 1] == []


def test_every_binding_has_an_action_and_every_action_a_binding():
    actions = {*EDITS, *COMMANDS, *DRAGS, "select at pointer", TYPE}
    assert set(ACTIONS) == actions
    assert len(ACTIONS) == len(set(ACTIONS))
    assert not set(EDITS) & set(COMMANDS)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_chord_of_the_table_is_found(layout):
    keymap = Keymap(layout)
    for binding in BINDINGS:
        for spelling in binding.spellings(keymap.layout):
            assert keymap.find(*parse_chord(spelling)) is binding


@pytest.mark.parametrize("layout", ["qwerty", "azerty"])
def test_texts_list_every_binding(layout):
    text, table = keys_text(layout), keys_markdown()
    for binding in BINDINGS:
        keys = " / ".join(map(platform_spelling, binding.spellings(layout)))
        assert any(line.split("  ")[1:2] == [keys] and line.endswith(binding.help) for line in text.splitlines())
        assert f"| {binding.help} | {' '.join(f'`{key}`' for key in binding.keys)} |" in table


def test_shift_is_ignored_by_fine_bindings_only():
    keymap = Keymap()
    assert keymap.find(Key.D, Modifier.SHIFT).action == "right"
    assert keymap.find(Button.WHEEL_UP, Modifier.SHIFT).action == "nearer"
    assert keymap.find(Key.P, Modifier.SHIFT) is None
    assert keymap.find(Key.TAB, Modifier.SHIFT).action == "select previous"


def test_escape_is_found_with_any_modifiers():
    everything = Modifier.SHIFT | Modifier.CTRL | Modifier.ALT
    assert Keymap().find(Key.ESCAPE, everything).action == "quit"
    assert Keymap().find(Key.C, Modifier.ALT) is None


def test_auto_follows_the_locale(monkeypatch):
    for name, layout in (("fr_FR", "azerty"), ("de_DE", "qwerty"), (None, "qwerty")):
        monkeypatch.setattr("locale.getlocale", lambda name=name: (name, "UTF-8"))
        assert resolve_layout("auto") == layout
        assert resolve_layout("qwertz") == "qwertz"


@pytest.mark.parametrize("spelling", ["Tabb", "Hyper+A", "Ctrl+?", "", "é"])
def test_spellings_are_parsed_and_unknown_ones_raise(spelling):
    known = {"Tab": Key.TAB, "a": Key.A, "F12": Key.F12, "PageUp": Key.PAGE_UP, "+": "+", "wheel up": Button.WHEEL_UP}
    assert [parse_chord(each) for each in known] == [Chord(code) for code in known.values()]
    assert parse_chord("Ctrl+Shift+S") == Chord(Key.S, Modifier.ACCEL | Modifier.SHIFT)
    with pytest.raises(KeyError):
        parse_chord(spelling)

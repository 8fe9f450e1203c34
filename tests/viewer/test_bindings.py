"""The table of bindings, its texts and keymaps; each key does what its help says, on each keyboard layout."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from math import dist
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.mlx import Button, Key, Modifier
from minirt.mlx.memory import Memory
from minirt.scene import Camera, describe, dump, load
from minirt.shapes import Plane, Sphere
from minirt.viewer.app.choosing import LISTS
from minirt.viewer.app.commands import COMMANDS
from minirt.viewer.app.events import PANEL
from minirt.viewer.app.menu import OPEN_MENU
from minirt.viewer.app.mouse import ZOOMS
from minirt.viewer.app.session import Session
from minirt.viewer.app.typed_value import BEGUN
from minirt.viewer.bindings import (
    BINDINGS,
    LAYOUTS,
    Binding,
    Keymap,
    chords_of,
    keys_text,
    parse_chord,
    platform_spelling,
    resolve_layout,
)
from minirt.viewer.display.overlay import HudLevel
from minirt.viewer.editing.dragging import DRAGS
from minirt.viewer.editing.editor import EDITS, apply
from minirt.viewer.editing.state import State
from tests.viewer.fake import TEXT, played, scene

ACTIONS = [binding.action for binding in BINDINGS]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_no_key_is_bound_twice(layout):
    counts = Counter(each for binding in BINDINGS for each in chords_of(binding, layout))
    assert [each for each, count in counts.items() if count > 1] == []


def test_every_binding_has_an_action_and_every_action_a_binding():
    gestures = {"select at pointer", "select too", PANEL, OPEN_MENU}
    actions = {*EDITS, *COMMANDS, *DRAGS, *ZOOMS, *LISTS, *BEGUN, *gestures}
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
    text = keys_text(layout)
    for binding in BINDINGS:
        keys = " / ".join(map(platform_spelling, binding.spellings(layout)))
        assert any(line.split("  ")[1:2] == [keys] and line.endswith(binding.help) for line in text.splitlines())


def test_shift_is_ignored_by_held_bindings_only():
    keymap = Keymap()
    assert keymap.find(Key.D, Modifier.SHIFT).action == "right"
    assert keymap.find(Button.WHEEL_UP, Modifier.SHIFT).action == "grow"
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


@pytest.mark.parametrize("letters", ["aw azerty", "qy qwerty", "qz qwertz", "py qwerty"])
def test_auto_follows_the_letters_of_the_keyboard_before_the_locale(monkeypatch, letters):
    monkeypatch.setattr("locale.getlocale", lambda: ("fr_FR", "UTF-8"))
    (q, y), layout = letters.split()
    keymap = Keymap("auto")
    assert keymap.layout == "azerty"
    keymap.follow({"q": q, "y": y}.__getitem__)
    assert keymap.layout == layout
    assert keymap.find(Key.W if layout != "azerty" else Key.Z).action == "forward"
    assert resolve_layout("qwerty", {"q": "a"}.__getitem__) == "qwerty"


@pytest.mark.parametrize("spelling", ["Tabb", "Hyper+A", "Ctrl+?", "", "é"])
def test_spellings_are_parsed_and_unknown_ones_raise(spelling):
    known = {"Tab": Key.TAB, "a": Key.A, "F12": Key.F12, "PageUp": Key.PAGE_UP, "+": "+", "wheel up": Button.WHEEL_UP}
    assert [parse_chord(each) for each in known] == [(code, Modifier.NONE) for code in known.values()]
    assert parse_chord("Ctrl+Shift+S") == (Key.S, Modifier.ACCEL | Modifier.SHIFT)
    with pytest.raises(KeyError):
        parse_chord(spelling)


# Effects of all keys.

SPHERE = ("press Tab", "press Tab")  # from the camera over the light
AT_SPHERE, AT_CYLINDER = "32,24", "40,24"  # pixels of a window of 64x48

Check = Callable[[Session, Session], bool]  # compares the sessions without and with the key
MOUSE = {
    "left click": (f"click {AT_SPHERE}",),
    "double click": (f"click {AT_SPHERE}", f"click {AT_SPHERE}"),
    "Shift+left click": ("down Shift", f"click {AT_CYLINDER}", "up Shift"),
    "right click": (f"click {AT_SPHERE} right",),
    "left drag": (f"drag {AT_SPHERE} 45,30",),
    "Shift+left drag": ("down Shift", f"drag {AT_CYLINDER} 48,36", "up Shift"),
    "Ctrl+left drag": ("down Ctrl", f"drag {AT_SPHERE} 45,40", "up Ctrl"),
    "Alt+left drag": ("down Alt", f"drag {AT_SPHERE} 45,40", "up Alt"),
    "Ctrl+Shift+left drag": ("down Ctrl", "down Shift", f"drag {AT_SPHERE} 45,40", "up Shift", "up Ctrl"),
    "right drag": ("drag 5,5 20,10 right",),
    "middle drag": (f"drag {AT_SPHERE} 45,30 middle",),
    "wheel up": (f"wheel up 1 {AT_SPHERE}",),
    "wheel down": (f"wheel down 1 {AT_SPHERE}",),
    "Shift+wheel up": ("down Shift", "wheel up", "up Shift"),
    "Shift+wheel down": ("down Shift", "wheel down", "up Shift"),
}


def approached(sign: float) -> Check:
    """Check that the camera came nearer to the sphere by a tenth of its distance, or went away."""

    def check(before: Session, after: Session) -> bool:
        (x, y, z), (a, b, c) = camera(before).position, camera(after).position
        is_ahead = (a, b) == pytest.approx((x, y), abs=0.02)  # the pointer is half a pixel beside the middle
        return is_ahead and sign * (z - c) == pytest.approx(1.0, abs=0.12) and camera(after).fov == 90

    return check


def stands_on_the_plane(_: Session, after: Session) -> bool:
    """Whether the sphere stands where the pointer was, on the plane y = -1 and on lines of the grid."""
    x, y, z = after.state.scene.spheres[0].centre
    lines = x / after.state.stride, z / after.state.stride
    return y == pytest.approx(0) and x > 0.5 and lines == pytest.approx(tuple(map(round, lines)))


def camera(session: Session) -> Camera:
    return session.state.scene.camera


def memory(session: Session) -> Memory:
    assert isinstance(session.display, Memory)
    return session.display


def focused(_: Session, after: Session) -> bool:
    """Whether the camera has a lens that is focused on the front of the sphere, whose diameter is 4 at most."""
    focus, there = camera(after).focus, dist(camera(after).position, (0, 0, 0))
    return focus is not None and camera(after).lens is not None and there - 2 <= focus < there


def saved_copy(_: Session, after: Session) -> bool:
    """Whether a copy of the scene was written."""
    path = after.path.with_name("scene-1.rt")
    return path.exists() and path.read_text() == dump(scene())


def saved_screenshot(before: Session, after: Session) -> bool:
    """Whether the picture without overlay was written."""
    path = after.path.with_name("scene-1.png")
    if not path.exists():
        return False
    with Image.open(path) as picture:
        return np.array_equal(np.asarray(picture), before.picture[..., 2::-1])


# Lines before an action of the editor; before the others the sphere is selected.
SETUPS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("turn left", "turn right", "turn up", "turn down", "roll left", "roll right"), ()),  # the camera
    "select camera": ("press Ctrl+D", *SPHERE),
    "look through": ("press Ctrl+D", "hold W 1", "hold Z 1"),
    "reset camera": ("press D", "press Left"),
    "undo": (*SPHERE, "press D"),
    "redo": (*SPHERE, "press D", "press Ctrl+Z"),
    "remove attribute": (*SPHERE, "press M"),
}


def facts(state: State) -> tuple[object, ...]:
    """What an action of the editor may change."""
    said = state.message.split("\n")[0]  # without what the picture does not show
    return state.scene.items, state.scene.shown, state.selected, state.value_index, state.frame, said


def edits_as(action: str) -> Check:
    """Check that a key does what the action of its name does in the editor, whose tests know that, and nothing else."""
    return lambda before, after: facts(after.state) == facts(apply(before.state, action)) != facts(before.state)


# For each action the lines before it and the check of its effect.
CHECKS: dict[str, tuple[tuple[str, ...], Check]] = {
    "select at pointer": ((), lambda _, after: isinstance(after.state.element, Sphere)),
    "select too": (SPHERE, lambda _, after: (after.state.element.title, len(after.state.others)) == ("cylinder", 1)),
    "open menu": ((), lambda _, after: bool(after.screen.list_box and after.screen.list_box.keys)),
    "move by hand": ((), lambda _, after: after.state.scene.spheres[0].centre[0] > 1),
    "turn by hand": ((), lambda _, after: after.state.scene.cylinders[0].axis != (0, 1, 0)),
    "place by hand": ((), stands_on_the_plane),
    "slide by hand": ((), lambda _, after: after.state.aim and stands_on_the_plane(_, after)),
    "orbit": (SPHERE, lambda _, after: camera(after).position[2] < 10 and camera(after).direction[2] > -1),
    "pan": ((), lambda _, after: camera(after).position[0] < -1 and camera(after).direction == (0, 0, -1)),
    "type value": (
        SPHERE,
        lambda _, after: after.screen.list_box is not None and "diameter, now 2: _" in after.screen.list_box.title,
    ),
    "rename": (
        SPHERE,
        lambda _, after: (
            after.screen.list_box is not None and after.screen.list_box.title.startswith("name of sphere 1: _")
        ),
    ),
    "nearer": ((), approached(1)),
    "farther": ((), approached(-1)),
    "explain pixel": (
        (f"move {AT_SPHERE}",),
        lambda _, after: (
            after.screen.explained is not None and after.screen.explained.parts[0].title.endswith("sphere 1")
        ),
    ),
    "next view": ((), lambda _, after: after.refinement.latest.job.view == "normals"),
    "focus": ((f"move {AT_SPHERE}",), focused),
    "choose colour": (SPHERE, lambda _, after: "as it is" in getattr(after.screen.list_box, "rows", ())),
    "choose second colour": (
        (*SPHERE, "press M", *(f"press {letter}" for letter in "CHECKER"), "press Return"),
        lambda _, after: getattr(after.screen.list_box, "title", "").startswith("checker colour"),
    ),
    "add attribute": (SPHERE, lambda _, after: after.state.element.specular is not None),
    "add": ((), lambda _, after: isinstance(after.state.element, Sphere) and len(after.state.scene.spheres) == 2),
    "add previous": (
        ("press N", "press N"),
        lambda before, after: isinstance(before.state.element, Plane) and isinstance(after.state.element, Sphere),
    ),
    "save": ((*SPHERE, "press D"), lambda before, after: load(after.path).scene.items == before.state.scene.items),
    "save copy": ((), saved_copy),
    "screenshot": ((), saved_screenshot),
    "reload": ((*SPHERE, "press D"), lambda _, after: after.state.scene.items == scene().items),
    "copy camera": ((), lambda _, after: memory(after).clipboard == describe(scene().camera)),
    "toggle HUD": ((), lambda before, after: after.screen.level == before.screen.level + 1 == HudLevel.ALL),
    "toggle icons": ((), lambda before, after: (before.screen.icons, after.screen.icons) == (False, True)),
    "toggle panel": ((), lambda _, after: "overlay" in after.window.hooks or "minirt[panel]" in after.state.message),
    "toggle handles": ((), lambda before, after: (before.screen.handles, after.screen.handles) == (True, False)),
    "toggle help": ((), lambda before, after: (before.screen.help, after.screen.help) == (False, True)),
    "larger text": ((), lambda before, after: after.screen.text_scale > before.screen.text_scale),
    "smaller text": ((), lambda before, after: after.screen.text_scale < before.screen.text_scale),
    "usual text": (("press Ctrl++",), lambda before, after: before.screen.text_scale > after.screen.text_scale == 1.0),
    "toggle full screen": ((), lambda _, after: (after.window.width, after.window.height) == memory(after).screen),
    "quit": ((), lambda _, after: after.state.selected == 1),
    **{action: (SETUPS.get(action, SPHERE), edits_as(action)) for action in EDITS},
}


def test_every_binding_has_a_check() -> None:
    assert set(CHECKS) == {binding.action for binding in BINDINGS}


@pytest.mark.parametrize("binding", BINDINGS, ids=lambda binding: binding.action)
def test_a_binding_does_what_its_help_says(binding: Binding, tmp_path: Path) -> None:
    setup, check = CHECKS[binding.action]
    afterwards = ("press Tab",) if binding.action == "quit" else ()  # must have no effect any more
    for number, spelling in enumerate(binding.spellings("qwerty")):
        path = tmp_path / f"{number}" / "scene.rt"
        path.parent.mkdir()
        path.write_text(TEXT)
        lines = MOUSE.get(spelling, (f"press {spelling}",))
        before = played(*setup, *afterwards, path=path)
        assert not check(before, before), "the check holds before the key"
        after = played(*setup, *lines, *afterwards, path=path)
        assert check(before, after), spelling

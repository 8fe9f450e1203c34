"""Every kind of element can be added, selected, moved, turned, resized, given attributes and saved.

The tests take all kinds from the registry and all fields from their tables, so that none is forgotten.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from math import copysign, hypot
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import Direction, Length, Lengths, Picture, Point
from minirt.materials import Compound
from minirt.rendering.packing.camera import camera_frame
from minirt.rendering.queries.pick import covers
from minirt.scene import Background, Camera, Resolution, Scene, dump, load, parse
from minirt.scene.elements import linear_combination
from minirt.scene.registry import ELEMENTS
from minirt.shapes import Box, Ellipsoid, Mesh, Shape, Sphere, Square
from minirt.viewer.display.overlay import fitting_words, hints
from minirt.viewer.editing.editor import EDITS, apply
from minirt.viewer.editing.projection import field_names, position_of, projection_of
from minirt.viewer.editing.state import State, index_of, initial_state
from minirt.viewer.editing.structure import ATTRIBUTE, ELEMENT, addable_kinds, choices, with_attribute
from minirt.viewer.editing.typed import set_typed
from minirt.viewer.editing.values import values
from tests.viewer.fake import played

BARE = "A 0.2 255,255,255\nC 0,2,-20 0.1,-0.1,1 60\n"
EDITABLE = [kind for kind in ELEMENTS.values() if kind is not Resolution]
ADDED = addable_kinds(parse(BARE).scene)
SIZE = (64, 48)  # of the window of `played`
WITH_ATTRIBUTES = [ELEMENTS[code] for code in ("sp", "sl", "C")]  # kinds whose attributes are those of all others


def attributes_of(kind: type[Element]) -> list[str]:
    """The names of the attributes of a kind that it may lack."""
    return [field.name for field in fields_of(kind) if field.keyed and field.default is None]


KEYED = [(kind, name) for kind in WITH_ATTRIBUTES for name in attributes_of(kind)]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A scene file with two pictures beside it, one of them in a folder, and two meshes."""
    (tmp_path / "more").mkdir()
    for name in ("a.png", "more/b.png"):
        Image.new("RGB", (4, 4), (200, 120, 40)).save(tmp_path / name)
    (tmp_path / "c.png").write_text("no picture")
    for name in ("a.obj", "more/b.obj"):
        (tmp_path / name).write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    (tmp_path / "c.obj").write_text("no mesh")
    scene = tmp_path / "scene.rt"
    scene.write_text(BARE)
    return scene


def holding(kind: type[Element], path: Path) -> State:
    """A state with an element of this kind selected."""
    state = initial_state(load(path).scene)
    if kind is Resolution:  # which no key adds
        state = initial_state(state.scene.add(Resolution(200, 100)))
    existing = [each for each in state.scene.elements if type(each) is kind]
    if existing:
        return state.select(index_of(state.scene, existing[0]))
    return next(each for _, each in choices(state, ELEMENT) if type(each.element) is kind).end_merging()


def tilted(state: State) -> State:
    """The state whose selected element has tilted directions, of which each part can be changed."""
    tilts = dict.fromkeys(field_names(type(state.element), Direction), (0.48, 0.6, 0.64))
    return replace(state, scene=state.scene.edit(state.selected, state.element.replace(**tilts)))


def checked(state: State) -> State:
    """Return the state after a check that its saved scene is read back as the same scene."""
    again = parse(dump(state.scene), state.scene.file).scene
    assert again.items == state.scene.items
    return state


def test_all_kinds_and_attributes_are_covered() -> None:
    assert {*ADDED, *(type(each) for each in parse(BARE).scene.elements)} == set(EDITABLE)
    assert len(EDITABLE) > 15
    assert {name for _, name in KEYED} == {name for kind in EDITABLE for name in attributes_of(kind)}


def messages(state: State) -> Iterator[str]:
    """Yield what the window says of the selected element after each action, and each typed value."""
    for action in EDITS:
        yield apply(state, action).message
    for index, value in enumerate(values(state.element)):
        active = replace(state, value_index=index)
        yield from (hints(active, every=True), fitting_words(active, 10_000, 16))
        yield from (apply(active, action, 1e9).message for action in ("grow", "shrink", "remove attribute"))
        yield from (
            set_typed(active, value, text, 0.0).message for text in ("-3", "0", "1e99", "1,2", "1,2,3", "*", "/0")
        )


@pytest.mark.parametrize(
    ("kind", "with_files"), [*((kind, True) for kind in EDITABLE), *((kind, False) for kind in WITH_ATTRIBUTES)]
)
def test_messages_are_words_without_underscores_and_none_twice(
    kind: type[Element], path: Path, with_files: bool
) -> None:
    state = holding(kind, path)
    if not with_files:
        for picture in path.parent.rglob("*.png"):
            picture.unlink()
    said = [*messages(state)]
    for field in fields_of(kind) if kind in WITH_ATTRIBUTES else ():
        if getattr(state.element, field.name) is None:
            try:
                added = with_attribute(state, field)
                said += [added.message, *messages(added)]
            except (LookupError, ElementError) as error:
                said.append(str(error))
    assert len(set(said)) > 20
    doubled = re.compile(r"\b([a-z]{2,})[ :]+\1\b", re.IGNORECASE)
    assert [each for each in said if "_" in each or doubled.search(each)] == []


@pytest.mark.parametrize("kind", ADDED[:-1], ids=lambda kind: kind.code)
def test_an_element_is_added_by_keys_clicked_moved_and_saved(kind: type[Element], path: Path) -> None:
    add = ["press N"] * (ADDED.index(kind) + 1)
    session = played(*add, text=BARE, path=path)
    assert type(session.state.element) is kind
    pixel = visible_pixel(session.state)
    icons = [] if issubclass(kind, Shape) else ["press G"]  # which may lie over a shape in so small a window
    for select in ["press Tab", *([f"click {pixel[0]},{pixel[1]}"] if pixel else [])]:
        found = played(*add, "press Return", "press C", *icons, select, text=BARE, path=path).state
        assert found.element == session.state.element
    edits = [f"press {key}" for key in ("Return", "d", "Right", "+", "M", "+", "Ctrl+S")]
    saved = played(*add, *edits, text=BARE, path=path)
    lines = path.read_text().splitlines()
    assert lines[:2] == BARE.splitlines()
    lamps = ["L"] if issubclass(kind, Shape) else []
    assert [line.split()[0] for line in lines[2:]] == [kind.code, *lamps]
    assert load(path).scene.items == saved.state.scene.items


def visible_pixel(state: State) -> tuple[int, int] | None:
    """A pixel that shows the selected element, by its surface or icon; None if it has no position."""
    element, camera = state.element, state.scene.camera
    x, y = (each.ravel() for each in np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])))
    if isinstance(element, Shape):
        (indices,) = np.nonzero(covers(element, camera, *SIZE, x, y))
        assert len(indices) > 3
        middle = indices[len(indices) // 2]
        return int(x[middle]), int(y[middle])
    place = position_of(element)
    at = projection_of(camera, *SIZE).pixel(place) if place else None
    return (round(at[0]), round(at[1])) if at else None


@pytest.mark.parametrize("kind", EDITABLE, ids=lambda kind: kind.code)
def test_an_element_moves_and_turns(kind: type[Element], path: Path) -> None:
    state = holding(kind, path)
    (right, _, _), _, (x, _, z) = camera_frame(state.scene.camera)
    level = hypot(x, z)
    axes = {"right": (z / level, 0.0, -x / level), "up": (0.0, 1.0, 0.0), "forward": (x / level, 0.0, z / level)}
    axes["right"] = tuple(copysign(1.0, right * z) * part for part in axes["right"])
    for action, axis in axes.items():
        moved = checked(apply(state, action))
        for name in field_names(kind, Point):
            there = linear_combination(1.0, getattr(state.element, name), state.stride, axis)
            assert getattr(moved.element, name) == pytest.approx(there, abs=1e-4 * state.stride)
        assert bool(field_names(kind, Point)) == (moved.element != state.element) == (not moved.message)
    for action in ("turn right", "turn up"):
        turned = checked(apply(state, action))
        places = [getattr(turned.element, name) for name in field_names(kind, Point)]
        can = turn_is_seen(state.element, action, len(places))
        assert can == (turned.element != state.element) == (not turned.message)
        assert not can or apply(turned, "undo").scene.items == state.scene.items


def turn_is_seen(element: Element, action: str, points: int) -> bool:
    """Whether a turn of a new element, which stands upright, changes the picture."""
    if action == "turn right":  # about the vertical
        return points > 1 or isinstance(element, (Camera, Box, Square, Ellipsoid, Mesh))
    return points > 1 or (bool(field_names(type(element), Direction)) and not isinstance(element, Sphere))


def changes(state: State) -> Iterator[tuple[str, State]]:
    """Yield each value of the selected element with the states after it was increased and decreased."""
    for _ in values(state.element):
        yield state.active.name, checked(apply(state, "grow"))
        yield state.active.name, checked(apply(state, "shrink"))
        state = apply(state, "next value")


@pytest.mark.parametrize("kind", EDITABLE, ids=lambda kind: kind.code)
def test_every_number_and_colour_can_be_changed(kind: type[Element], path: Path) -> None:
    state = tilted(holding(kind, path))
    active = {value.field.name for value in values(state.element)}
    given = {each.name for each in fields_of(kind) if getattr(state.element, each.name) is not None}
    unseen = set() if isinstance(state.element, (Box, Square, Ellipsoid, Mesh, Camera)) else {"roll"}
    unseen |= {each.name for each in fields_of(kind) if each.keyed and isinstance(each, Direction)} if unseen else set()
    assert active == given - unseen
    for name, after in changes(state):
        field = next(value.field for value in values(state.element) if value.name == name)
        stands = isinstance(field, Length | Lengths)  # and goes on standing: its place may change
        others = {each.name for each in fields_of(kind) if not (stands and isinstance(each, Point))} - {field.name}
        assert all(getattr(after.element, each) == getattr(state.element, each) for each in others)
        assert (after.element != state.element) or "cannot go further" in after.message
    changed = {name for name, after in changes(state) if after.element != state.element}
    assert changed == {value.name for value in values(state.element)}


@pytest.mark.parametrize(("kind", "name"), KEYED, ids=lambda part: getattr(part, "code", part))
def test_every_attribute_is_added_changed_and_removed(kind: type[Element], name: str, path: Path) -> None:
    start = holding(kind, path)
    names = [each for of, each in KEYED if of is kind]
    state = checked(list(choices(start, ATTRIBUTE))[names.index(name)][1])
    assert getattr(state.element, name) is not None
    assert [each for each in names if getattr(state.element, each) is not None] == [name]
    assert state.active.field.name == name
    assert len(state.undo_stack) == len(start.undo_stack) + 1

    own = [value for value in values(state.element) if value.field.name == name and value.channel is None]
    field = own[0].field
    assert len(own) == (len(fields_of(field.record)) if isinstance(field, Compound) else 1)
    for value in own:
        at = replace(state, value_index=values(state.element).index(value)).end_merging()
        outcomes = [checked(apply(at, action)).element for action in ("grow", "shrink")]
        assert any(each != state.element for each in outcomes), value.name
        assert all(getattr(each, other) is None for each in outcomes for other in names if other != name)
        if isinstance(value.inner or field, Picture):
            assert [value.get(each) for each in (state.element, *outcomes)] == ["a.png", "more/b.png", "more/b.png"]

    removed = checked(apply(state, "remove attribute"))
    assert removed.element == start.element
    assert apply(removed, "undo").element == state.element
    assert apply(apply(removed, "undo"), "undo").element == start.element


def test_attributes_with_pictures_need_a_picture_beside_the_scene(tmp_path: Path) -> None:
    scene = parse(BARE + "sp 0,0,0 1 9,9,9\n").scene
    state = initial_state(Scene((*scene.elements, Background("sky.png")), tmp_path / "scene.rt")).select(2)
    names = {each.active.field.name for _, each in choices(state, ATTRIBUTE)}
    with_picture = {"texture", "bump", "normal_map"}
    assert names == {name for kind, name in KEYED if kind is ELEMENTS["sp"]} - with_picture
    sky = apply(state.select(3), "grow")
    assert "no other picture" in sky.message
    assert sky.scene is state.scene


def test_the_size_of_a_mesh_comes_before_its_file_which_can_be_changed(path: Path) -> None:
    state = holding(Mesh, path)
    assert state.active.field.name == "scale"
    while state.active.field.name != "file":
        state = apply(state, "next value")
    for action, name in (("grow", "more/b.obj"), ("grow", "a.obj"), ("shrink", "more/b.obj")):
        state = apply(state, action)
        assert state.element.file.name == name
    (path.parent / "a.obj").unlink()
    assert "no other mesh" in apply(state, "grow").message
    *others, last = (type(each.element) for _, each in choices(state, ELEMENT))
    assert last is Mesh
    (path.parent / "more" / "b.obj").unlink()
    assert [type(each.element) for _, each in choices(state, ELEMENT)] == others

"""The writer keeps a file as it was read, but for the changed fields; random scenes survive writing and reading."""

from __future__ import annotations

import re
from typing import Any

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.fields import unit
from minirt.materials import Checker, Glass, Specular
from minirt.scene import Camera, FurtherLight, Light, Scene, describe, dump, parse
from minirt.shapes.sphere import Sphere
from tests.scene.examples import AMBIENT, CAMERA, CYLINDER, LIGHT, PLANE, SPHERE, WHOLE, read, scene_with
from tests.scene.strategies import scenes, texts, values

BALL = Sphere((0.0, 0.0, 20.0), 12.6, (10, 0, 255))


@pytest.mark.parametrize(
    ("before", "changes", "after"),
    [
        (SPHERE, {"diameter": 3.0}, "sp 0,0,20 3 10,0,255"),
        (SPHERE, {"diameter": 0.1 + 0.2}, "sp 0,0,20 0.30000000000000004 10,0,255"),
        ("  sp 0,0,20 12.6 10,0,255  # red \r", {"diameter": 1.0}, "  sp 0,0,20 1 10,0,255  # red \r"),
        ("sp 0,0,20   12.6   10,0,255 # a", {"diameter": 1.0}, "sp 0,0,20   1      10,0,255 # a"),
        ("sp 0,0,20   12.6   10,0,255 # a", {"centre": (0.25, 0.5, 20.0)}, "sp 0.25,0.5,20 12.6   10,0,255 # a"),
        ("sp 0,0,20 12.6 10,0,255   ", {"colour": (0, 0, 255)}, "sp 0,0,20 12.6 0,0,255   "),
        ("sp 0,0,20 12.6 10,0,255#glued", {"colour": (0, 0, 0)}, "sp 0,0,20 12.6 0,0,0#glued"),
        ("sp 0,0,20 20 20,20,20", {"diameter": 5.0, "colour": (1, 1, 1)}, "sp 0,0,20 5 1,1,1"),
        ("l 0,0,0 0.5 # warm", {"colour": (255, 200, 0)}, "l 0,0,0 0.5 255,200,0 # warm"),
        (f"{SPHERE}  # ball", {"checker": Checker(2.0)}, f"{SPHERE} checker:2  # ball"),
        (f"{SPHERE} spc:0.50,30 # a", {"specular": Specular(0.5, 40)}, f"{SPHERE} spc:0.5,40 # a"),
        (f"{SPHERE} spc:0.5,30,blinn", {"specular": Specular(0.5, 30)}, f"{SPHERE} spc:0.5,30"),
        (f"{SPHERE} glass:1.5 mirror:0.1", {"glass": Glass(1.5, 0.5)}, f"{SPHERE} glass:1.5,0.5 mirror:0.1"),
        (f"{SPHERE} checker mirror:1 # b", {"diameter": 2.0}, "sp 0,0,20 2 10,0,255 checker mirror:1 # b"),
        (f"{SPHERE} pat mirror:1 # b", {"checker": None}, f"{SPHERE} mirror:1 # b"),
        (f"{SPHERE} mirror:0.5 checker", {"mirror": None, "checker": None, "glass": Glass(2)}, f"{SPHERE} glass:2"),
        ("L 0,0,0 1 fade:9 size:2", {"size": None}, "L 0,0,0 1 fade:9"),
    ],
)
def test_only_the_changed_field_of_a_line_changes(before: str, changes: dict[str, Any], after: str) -> None:
    scene = read("# one", before, "# two")
    changed = scene.replace(scene.elements[2], **changes)
    assert dump(changed) == scene_with("# one", after, "# two")
    assert parse(dump(changed)).scene.items == changed.items
    described = describe(changed.elements[2])
    assert dump(changed.replace(changed.elements[2], source="")) == scene_with("# one", described, "# two")


@pytest.mark.parametrize(
    ("before", "changes", "after"),
    [
        ("C 0,0,0 0,0,1 70", {"roll": 5.0}, "C 0,0,0 0,0,1 70 roll:5"),
        ("C 0,0,0 0,0,1 70 # eye", {"roll": 5.0, "fov": 60.0}, "C 0,0,0 0,0,1 60 roll:5 # eye"),
        ("C 0,0,0 0,0,1 70 roll:5.50  # eye", {"roll": -1.0}, "C 0,0,0 0,0,1 70 roll:-1    # eye"),
        ("C 0,0,0 0,0,1 70 roll:5", {"roll": 0.0}, "C 0,0,0 0,0,1 70 roll:0"),
        ("C 0,0,0 0,0,1 70 roll:0", {"fov": 7.5}, "C 0,0,0 0,0,1 7.5 roll:0"),
        ("C 0,0,0 0,0,1 70 lens:0.25 focus:7.5", {"lens": None}, "C 0,0,0 0,0,1 70 focus:7.5"),
        ("C 0,0,0 0,0,1 70", {"direction": (0.0, 1.0, 0.0)}, "C 0,0,0 0,1,0 70"),
    ],
)
def test_an_attribute_is_rewritten_or_added(before: str, changes: dict[str, Any], after: str) -> None:
    scene = parse(f"{AMBIENT}\n{before}\n").scene
    changed = scene.replace(scene.camera, **changes)
    assert dump(changed) == f"{AMBIENT}\n{after}\n"
    assert parse(dump(changed)).scene.items == changed.items


def test_changing_back_restores_the_file() -> None:
    text = WHOLE.replace("12.6", "012.60")
    scene = parse(text).scene
    there = scene.replace(scene.spheres[0], diameter=1.0)
    assert dump(there) != text
    assert dump(there.replace(there.spheres[0], diameter=12.6)) == text


def test_a_byte_order_mark_stays_in_the_first_line() -> None:
    text = f"\ufeff  {AMBIENT} # a\r\n{CAMERA}\r\n"
    scene = parse(text).scene
    assert scene.ambient is not None
    assert dump(scene) == text
    assert dump(scene.replace(scene.ambient, brightness=0.5)) == text.replace("0.2", "0.5")


def test_a_copy_of_the_first_line_has_no_byte_order_mark() -> None:
    text = f"\ufeff{SPHERE}\n{AMBIENT}\n{CAMERA}"
    scene = parse(text).scene
    copied = Scene((*scene.items, scene.spheres[0]))
    assert dump(copied) == f"{text}\n{SPHERE}"


@pytest.mark.parametrize(
    "source",
    [
        *("", "# a comment", "nonsense", PLANE, CYLINDER, "sp 0,0,20 12.6", "sp 0,0,20 nan 10,0,255", "l 0,0,0 1"),
        *(
            SPHERE + "\n" + SPHERE,
            SPHERE + " # \0",
            SPHERE + "\rx",
            SPHERE + " 7",
            SPHERE + " fov:1",
            "\ufeff\ufeff" + SPHERE,
        ),
    ],
)
def test_an_element_without_a_fitting_source_line_gets_a_new_line(source: str) -> None:
    scene = Scene([*read().items[:2], Sphere(BALL.centre, BALL.diameter, BALL.colour, source=source)])
    assert dump(scene) == f"{AMBIENT}\n{CAMERA}\n{SPHERE}"


@pytest.mark.parametrize(
    ("element", "line"),
    [
        (BALL, SPHERE),
        (Camera((0, 0, -5), (0, 0, 1), 70), CAMERA),
        (Camera((0, 0, -5), (0, 0, 1), 70, roll=1 / 3), CAMERA + " roll:0.3333333333333333"),
        (Light((-40, 0, 30), 0.7), LIGHT),
        (FurtherLight((0, 0, 0), 1, (1, 2, 3)), "l 0,0,0 1 1,2,3"),
        (Sphere((1e15, -1e-300, 1e22 / 1e22), 1e-50, (0, 0, 0)), "sp 1000000000000000,-1e-300,1 1e-50 0,0,0"),
        (Sphere((-0.0, 0, 0), 1, (0, 0, 0), source="  sp 0,0,0  1  0,0,0 # kept out"), "sp 0,0,0 1 0,0,0"),
    ],
)
def test_an_element_is_described_by_its_line(element: Element, line: str) -> None:
    assert describe(element) == line


def test_a_written_direction_reads_back_to_the_same_bits() -> None:
    normal = unit((0.1, 0.2, 0.3))
    scene = read(PLANE)
    changed = scene.replace(scene.planes[0], normal=normal)
    again = parse(dump(changed)).scene
    assert again.planes[0].normal == changed.planes[0].normal == normal
    assert dump(again) == dump(changed)


@given(scenes())
@settings(max_examples=100, deadline=None)
def test_a_written_scene_reads_as_the_same_scene(scene: Scene) -> None:
    text = dump(scene)
    again = parse(text).scene
    assert again == scene
    assert dump(again) == text


@given(texts())
@settings(max_examples=150, deadline=None)
def test_a_file_that_is_read_is_written_as_it_was(text: str) -> None:
    scene = parse(text).scene
    assert dump(scene) == text
    assert parse(text, lenient=True).scene == scene
    assert parse(dump(Scene(scene.elements))).scene.elements == scene.elements


@given(texts(), st.data())
@settings(max_examples=150, deadline=None)
def test_an_edit_changes_one_line_and_keeps_its_comment(text: str, data: st.DataObject) -> None:
    scene = parse(text).scene
    index = data.draw(st.sampled_from([index for index, item in enumerate(scene.items) if isinstance(item, Element)]))
    element = scene.items[index]
    assert isinstance(element, Element)
    fields = data.draw(st.lists(st.sampled_from(fields_of(type(element))), min_size=1, unique=True))
    changes: dict[str, Any] = {field.name: data.draw(values(field)) for field in fields}
    try:
        changed = scene.replace(element, **changes)
    except ElementError:  # the fields do not go together
        reject()
    before, after = text.split("\n"), dump(changed).split("\n")
    assert before[:index] + before[index + 1 :] == after[:index] + after[index + 1 :]
    frame = re.compile(r"(\ufeff?[ \t]*)[^#]*?([ \t]*#.*)?(\r?)", re.DOTALL)
    kept = [match.groups() if (match := frame.fullmatch(line)) else None for line in (before[index], after[index])]
    assert [part and part.strip(" ") for part in kept[0] or ()] == [part and part.strip(" ") for part in kept[1] or ()]
    again = parse(dump(changed)).scene
    assert again.elements == changed.elements
    assert dump(again) == dump(changed)

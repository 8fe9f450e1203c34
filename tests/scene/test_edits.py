"""Edits of scenes: what they make, and how little of a long scene they make anew."""

from __future__ import annotations

import pickle
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from minirt.element import Element
from minirt.scene import Ambient, Camera, FurtherLight, Item, Light, Scene, dump, pages, parse, writer
from minirt.scene.pages import PAGE_LENGTH, Page
from minirt.shapes import Shape
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.scene.examples import SPHERE, scene_with

CAMERA = Camera((0, 0, 0), (0, 0, 1), 70)
BALL = Sphere((0, 0, 0), 1, (1, 2, 3))
OTHERS: list[Element] = [BALL, Plane((0, 0, 0), (0, 1, 0), (1, 2, 3)), FurtherLight((0, 0, 0), 1)]


@pytest.fixture(scope="module")
def long() -> Scene:
    """A scene of many pages."""
    spheres = [f"sp {index},0,0 1 1,2,3" for index in range(20 * PAGE_LENGTH)]
    return parse(scene_with("# spheres", *spheres, "l 0,0,0 1")).scene


def anew(scene: Scene, old: Scene) -> list[Page]:
    """The pages that the old scene does not have."""
    return [page for page in scene.pages if not any(page is each for each in old.pages)]


@given(st.data())
@settings(max_examples=200, deadline=None)
def test_edits_make_the_scene_that_a_list_would(data: st.DataObject) -> None:
    items: list[Item] = data.draw(st.lists(st.sampled_from([*OTHERS, "", "# a"]), max_size=9))
    items.insert(data.draw(st.integers(0, len(items))), CAMERA)
    with patch.object(pages, "ITEMS", 3):
        scene = Scene(items)
        for _ in range(data.draw(st.integers(1, 8))):
            places = [place for place, item in enumerate(items) if isinstance(item, Element)]
            index = data.draw(st.integers(0, len(places) - 1))
            instead = data.draw(st.lists(st.sampled_from(OTHERS), max_size=4))
            if items[places[index]] is CAMERA:
                instead.append(CAMERA)
            items[places[index] : places[index] + 1] = instead
            scene = scene.edit(index, *instead)
            assert all(0 < len(page.items) <= 2 * pages.PAGE_LENGTH for page in scene.pages)
    elements = [item for item in items if isinstance(item, Element)]
    assert scene == Scene(items)
    assert scene.items == tuple(items)
    assert scene.elements == tuple(elements)
    assert scene.shapes == tuple(each for each in elements if isinstance(each, Shape))
    assert scene.lights == tuple(each for each in elements if isinstance(each, Light))
    assert scene.spheres == tuple(each for each in elements if type(each) is Sphere)
    assert scene.camera is CAMERA
    assert list(scene.indices_of(Light)) == [i for i, each in enumerate(elements) if isinstance(each, Light)]
    assert dump(scene) == dump(Scene(items))


def test_an_empty_page_is_left_out() -> None:
    with patch.object(pages, "ITEMS", 1):
        scene = Scene([BALL, CAMERA, BALL])
        assert len(scene.pages) == 3
        assert [page.items for page in scene.edit(2).edit(0).pages] == [(CAMERA,)]


def test_an_edit_makes_one_page_anew(long: Scene) -> None:
    for index in (5 * PAGE_LENGTH, 0, len(long.elements) - 1):
        element = long.elements[index]
        for changed in (long.edit(index, element), long.edit(index, element, BALL)):
            assert len(anew(changed, long)) == 1
    assert len(anew(long.edit(5), long)) == 1
    assert len(anew(long.replace(long.spheres[3], diameter=2), long)) == 1
    assert len(anew(Scene(long.items), long)) == len(long.pages)


def test_an_edit_looks_at_no_item_of_other_pages(long: Scene) -> None:
    looked: list[Page] = []
    assert long.elements[0] is not long.camera  # all pages know now what each edit asks of them

    def find(page: Page, sort: type) -> tuple[Item, ...]:
        looked.append(page)
        return known(page, sort)

    known = Page._find
    with patch.object(Page, "_find", find):
        changed = long.edit(5 * PAGE_LENGTH, BALL)
        assert changed.elements[5 * PAGE_LENGTH] is BALL
        assert changed.camera is long.camera
    assert looked
    assert {id(page) for page in looked} == {id(page) for page in anew(changed, long)}


def test_what_is_no_shape_leaves_the_shapes_as_they_are(long: Scene) -> None:
    index = next(long.indices_of(Camera))
    shapes = long.shapes
    assert long.edit(index, long.camera.replace(fov=20)).shapes is shapes
    assert long.edit(next(long.indices_of(FurtherLight))).shapes is shapes
    assert long.edit(next(long.indices_of(Sphere)), BALL).shapes is not shapes
    assert long.edit(index, long.camera, BALL).shapes == (BALL, *shapes)
    light = len(long.elements) - 1
    assert long.edit(light, BALL).shapes == (*shapes, BALL)
    assert long.drop_caches() is long
    assert long.shapes == shapes
    assert long.shapes is not shapes


def test_an_edit_keeps_the_rules() -> None:
    scene = Scene([Ambient(1, (1, 2, 3)), CAMERA])
    with pytest.raises(ValueError, match="exactly one camera, got 0"):
        scene.edit(1)
    with pytest.raises(ValueError, match="exactly one camera, got 2"):
        scene.edit(0, CAMERA)
    with pytest.raises(ValueError, match="at most one ambient light, got 2"):
        scene.edit(0, *[Ambient(1, (1, 2, 3))] * 2)
    with pytest.raises(IndexError):
        scene.edit(2)
    assert scene.edit(-1, CAMERA) == scene


def test_a_scene_is_pickled_whole(long: Scene) -> None:
    again = pickle.loads(pickle.dumps(long))
    assert again == long
    assert hash(again) == hash(long)
    assert dump(again) == dump(long)


def test_only_lines_that_changed_are_written_with_care(long: Scene) -> None:
    written: list[Element] = []

    def line_of(element: Element) -> str:
        written.append(element)
        return careful(element)

    careful = writer.line_of
    changed = long.replace(long.spheres[7], diameter=3)
    with patch.object(writer, "line_of", line_of):
        text = dump(changed)
    once = [each for each in changed.elements if type(each).once]
    assert list(map(id, written)) == list(map(id, [*once, changed.spheres[7], changed.lights[-1]]))
    assert text == dump(long).replace("\nsp 7,0,0 1 ", "\nsp 7,0,0 3 ")


@pytest.mark.parametrize("source", ["sp 0,0,0 1 1,2,4", "pl 0,0,0 0,1,0 1,2,3", "# a", SPHERE + "\n" + SPHERE])
def test_a_plain_line_that_says_something_else_is_not_written(source: str) -> None:
    assert dump(Scene([CAMERA, Sphere(BALL.centre, 1, BALL.colour, source=source)])).endswith("\nsp 0,0,0 1 1,2,3")

"""Edits of scenes give the right scene, and copy only one page of a long one."""

from __future__ import annotations

import pickle
from itertools import chain
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from minirt.element import Element
from minirt.rendering.packing.features import features
from minirt.scene import Ambient, Camera, FurtherCamera, FurtherLight, Item, Light, Scene, dump, pages, parse, writer
from minirt.scene.pages import PAGE_LENGTH, Page
from minirt.shapes import Plane, Shape, Sphere
from tests.scene.examples import SPHERE, scene_with

CAMERA = Camera((0, 0, 0), (0, 0, 1), 70)
BALL = Sphere((0, 0, 0), 1, (1, 2, 3))
OTHERS: list[Element] = [BALL, Plane((0, 0, 0), (0, 1, 0), (1, 2, 3)), FurtherLight((0, 0, 0), 1)]


def test_a_scene_is_seen_by_each_of_its_cameras() -> None:
    further = FurtherCamera((9, 0, 0), (-1, 0, 0), 50, lens=0.5)
    scene = Scene([further, BALL, CAMERA])
    assert scene.cameras == (CAMERA, further)
    seen = scene.seen_by(2)
    assert (scene.camera, seen.camera) == (CAMERA, further)
    assert (seen == scene, seen.items == scene.items, seen.seen_by(1) == scene) == (False, True, True)
    for edited in (seen.add(BALL), seen.replace(BALL, diameter=2), seen.remove(BALL), pickle.loads(pickle.dumps(seen))):
        assert edited.camera is further or edited.camera == further
    assert seen.remove(further).camera is CAMERA
    moved = seen.replace(further, Camera((1, 2, 3), (0, 0, 1), 40))
    assert dump(moved).splitlines()[0] == "c 1,2,3 0,0,1 40"
    assert moved.camera.position == (1, 2, 3)
    assert [each.left_handed for each in seen.mirrored().cameras] == [True, True]
    assert "lens" in features(seen)
    assert "lens" not in features(scene)
    for number in (0, 3):
        with pytest.raises(ValueError, match=f"the scene has 2 cameras, got the number {number}"):
            scene.seen_by(number)


@pytest.fixture(scope="module")
def long() -> Scene:
    """A scene of many pages."""
    spheres = [f"sp {index},0,0 1 1,2,3" for index in range(20 * PAGE_LENGTH)]
    return parse(scene_with("# spheres", *spheres, "l 0,0,0 1")).scene


def new_pages(scene: Scene, old: Scene) -> list[Page]:
    """Return the pages of a scene that the old scene does not share."""
    return [page for page in scene.pages if not any(page is each for each in old.pages)]


@given(st.data())
@settings(max_examples=200, deadline=None)
def test_edits_give_the_scene_of_an_edited_list(data: st.DataObject) -> None:
    items: list[Item] = data.draw(st.lists(st.sampled_from([*OTHERS, "", "# a"]), max_size=9))
    items.insert(data.draw(st.integers(0, len(items))), CAMERA)
    with patch.object(pages, "PAGE_LENGTH", 3):
        scene = Scene(items)
        for _ in range(data.draw(st.integers(1, 8))):
            indices = [index for index, item in enumerate(items) if isinstance(item, Element)]
            index = data.draw(st.integers(0, len(indices) - 1))
            new = data.draw(st.lists(st.sampled_from(OTHERS), max_size=4))
            if items[indices[index]] is CAMERA:
                new.append(CAMERA)
            items[indices[index] : indices[index] + 1] = new
            scene = scene.edit(index, *new)
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
    with patch.object(pages, "PAGE_LENGTH", 1):
        scene = Scene([BALL, CAMERA, BALL])
        assert len(scene.pages) == 3
        assert [page.items for page in scene.edit(2).edit(0).pages] == [(CAMERA,)]


def test_an_edit_copies_one_page(long: Scene) -> None:
    for index in (5 * PAGE_LENGTH, 0, len(long.elements) - 1):
        element = long.elements[index]
        for changed in (long.edit(index, element), long.edit(index, element, BALL)):
            assert len(new_pages(changed, long)) == 1
    assert len(new_pages(long.edit(5), long)) == 1
    assert len(new_pages(long.replace(long.spheres[3], diameter=2), long)) == 1
    assert len(new_pages(Scene(long.items), long)) == len(long.pages)
    assert long.pages[5].of(Camera) is long.pages[5].of(Camera)  # a page is searched once
    assert long.pages[0].of(Camera) is long.pages[0].of(Camera)


def test_an_edit_keeps_the_runs_of_shapes_of_other_pages(long: Scene) -> None:
    index, shapes = next(long.indices_of(Camera)), long.shapes
    for edited in (long.edit(index, long.camera.replace(fov=20)), long.edit(next(long.indices_of(Sphere)), BALL)):
        assert sum(one is not other for one, other in zip(edited.runs, long.runs, strict=True)) == 1
        assert tuple(chain.from_iterable(edited.runs)) == edited.shapes
    assert long.edit(index, long.camera, BALL).shapes == (BALL, *shapes)
    light = len(long.elements) - 1
    assert long.edit(light, BALL).shapes == (*shapes, BALL)
    assert long.drop_caches() is long
    assert long.shapes == shapes
    assert long.shapes is not shapes


def test_an_edit_checks_the_number_of_unique_elements() -> None:
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


def test_a_scene_can_be_pickled(long: Scene) -> None:
    again = pickle.loads(pickle.dumps(long))
    assert again == long
    assert hash(again) == hash(long)
    assert dump(again) == dump(long)


def test_only_changed_lines_are_rewritten(long: Scene) -> None:
    rewritten: list[Element] = []

    def line_of(element: Element) -> str:
        rewritten.append(element)
        return original(element)

    original = writer.line_of
    changed = long.replace(long.spheres[7], diameter=3)
    with patch.object(writer, "line_of", line_of):
        text = dump(changed)
    once = [each for each in changed.elements if type(each).once]
    assert list(map(id, rewritten)) == list(map(id, [*once, changed.spheres[7], changed.lights[-1]]))
    assert text == dump(long).replace("\nsp 7,0,0 1 ", "\nsp 7,0,0 3 ")


@pytest.mark.parametrize("source", ["sp 0,0,0 1 1,2,4", "pl 0,0,0 0,1,0 1,2,3", "# a", SPHERE + "\n" + SPHERE])
def test_a_source_line_of_another_element_is_not_written(source: str) -> None:
    assert dump(Scene([CAMERA, Sphere(BALL.centre, 1, BALL.colour, source=source)])).endswith("\nsp 0,0,0 1 1,2,3")


def test_elements_are_added_before_the_last_blank_line_and_removed() -> None:
    scene = Scene([CAMERA, BALL, ""])
    more = scene.add(*OTHERS)
    assert more.items == (CAMERA, BALL, *OTHERS, "")
    assert more.remove(BALL, OTHERS[1]) == Scene([CAMERA, BALL, OTHERS[2], ""])
    with pytest.raises(ValueError, match="the scene has no"):
        scene.remove(OTHERS[1])

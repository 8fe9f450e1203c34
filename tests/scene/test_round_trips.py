"""Round trips: random scenes survive writing and reading, and a random edit changes only its own line."""

from __future__ import annotations

import re
from typing import Any

from hypothesis import given, reject, settings
from hypothesis import strategies as st

from minirt.element import Element, fields_of
from minirt.errors import ElementError
from minirt.scene import Scene, describe, dump, parse
from tests.scene.strategies import ANY, ONCE, scenes, texts, values


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
    assert parse(text, lenient=True) == parse(text)
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


@given(st.one_of(*ANY, *ONCE))
@settings(max_examples=100, deadline=None)
def test_a_description_reads_as_the_same_element(element: Element) -> None:
    assert parse(f"A 0 0,0,0\nC 0,0,0 0,0,1 70\n{describe(element)}").scene.elements[2] == element

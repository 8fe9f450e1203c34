"""Names of elements, and new ones in the comments of their lines."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.scene import Scene, dump, parse
from minirt.scene.names import LONGEST, element_name, own_name, renamed
from minirt.scene.pages import PAGE_LENGTH

HEAD = "A 0.2 255,255,255\nC 0,0,10 0,0,-1 60\n"
BALL, TUBE = "sp 0,0,0 2 9,9,9", "cy 0,0,0 0,1,0 1 2 9,9,9"


def names(text: str) -> list[str]:
    scene = parse(HEAD + text).scene
    return [element_name(scene, index) for index in range(len(scene.elements))][2:]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (f"{BALL}\n{TUBE}\n{BALL}\n{TUBE}", "sphere 1, cylinder 1, sphere 2, cylinder 2"),
        (f"{BALL} # head\n{BALL}#  left  eye \n{BALL} #", "head, left  eye, sphere 3"),
        (f"# hat\n{TUBE}\n\n{TUBE}", "hat, cylinder 2"),
        (f"# arms\n{TUBE}\n{TUBE}\n# legs\n{TUBE}\n{BALL}", "arms 1, arms 2, legs 1, legs 2"),
        (f"## arms ##\n{TUBE}\n{BALL} # head\n{TUBE}", "arms 1, head, arms 2"),
        (f"# arms\n\n{TUBE}", "cylinder 1"),
        (f"# {'long ' * 9}\n{TUBE}\n#{TUBE}\n{TUBE}", "cylinder 1, cylinder 2"),
        (f"# {BALL}\n{TUBE}\n# A sphere\n{BALL}", "cylinder 1, A sphere"),
        ("L 0,9,0 1\nl 0,9,0 1\nl 0,9,0 1\n# sun\ndl 0,-1,0 1\ndl 0,-1,0 1", "light 1, light 2, light 3, sun 1, sun 2"),
        ("c 0,0,9 0,0,-1 60\nR 200 100\nbg 0,0,0", "camera 2, resolution, background"),
    ],
)
def test_elements_are_named_by_their_lines_by_blocks_or_by_numbers(text: str, expected: str) -> None:
    assert ", ".join(names(text)) == expected


def test_a_comment_above_settings_of_a_scene_is_about_the_file() -> None:
    scene = parse(f"# my scene\nA 0.2 255,255,255\nC 0,0,10 0,0,-1 60 # eye\n{BALL}").scene
    assert [element_name(scene, index) for index in range(3)] == ["ambient light", "eye", "sphere 1"]


def test_names_go_on_over_pages() -> None:
    text = f"{BALL}\n" * (PAGE_LENGTH - 4) + f"# arms\n{TUBE}\n{TUBE}\n{TUBE}\n\n{BALL}\n"
    named = names(text)
    assert named[-5:] == [f"sphere {PAGE_LENGTH - 4}", "arms 1", "arms 2", "arms 3", f"sphere {PAGE_LENGTH - 3}"]


def with_name(scene: Scene, index: int, name: str) -> Scene:
    return scene.edit(index, renamed(scene.elements[index], name))


@pytest.mark.parametrize(
    ("line", "name", "expected"),
    [
        (BALL, "head", f"{BALL} # head"),
        (f"  {BALL}\t ", "head", f"  {BALL} # head"),
        ("sp   0,0,0  2.00 9,9,9   #old", " new\tname\n", "sp   0,0,0  2.00 9,9,9   # new name"),
        (f"{BALL}   # old", "", BALL),
        (f"{BALL} # old\r", "new # 2", f"{BALL} # new # 2\r"),
        (f"{BALL}\r", "né", f"{BALL} # né\r"),
    ],
)
def test_a_new_name_changes_the_comment_of_a_line_and_nothing_else(line: str, name: str, expected: str) -> None:
    text = f"{HEAD}{line}\n# end\n"
    assert dump(with_name(parse(text).scene, 2, name)) == f"{HEAD}{expected}\n# end\n"


def test_a_new_element_and_a_changed_one_get_names_that_later_changes_keep() -> None:
    scene = parse(HEAD + BALL).scene
    scene = scene.edit(2, scene.elements[2].replace(diameter=3), scene.elements[2].replace(source="", diameter=4))
    scene = with_name(with_name(scene, 2, "one"), 3, "two")
    scene = scene.edit(3, scene.elements[3].replace(diameter=5))
    assert dump(scene) == f"{HEAD}sp 0,0,0 3 9,9,9 # one\nsp 0,0,0 5 9,9,9 # two"


@given(st.text(max_size=LONGEST))
def test_any_name_leaves_the_element_as_it_was(name: str) -> None:
    scene = parse(HEAD + BALL).scene
    again = parse(dump(with_name(scene, 2, name))).scene
    assert again.elements == scene.elements
    assert len(dump(scene).split("\n")) == len(dump(again).split("\n"))
    if all(each.isalpha() for each in name):
        assert own_name(again.elements[2]) == name

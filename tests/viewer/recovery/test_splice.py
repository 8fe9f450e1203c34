"""Splices turn the lines of one version of a scene into those of another."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from minirt.scene import Scene, dump, parse
from minirt.viewer.recovery.splice import Splice, difference
from tests.viewer.fake import TEXT, scene


def spliced(old: Scene, new: Scene) -> str:
    """Return the text of the old scene with the difference to the new one."""
    lines = dump(old).split("\n")
    splice = difference(old, new)
    if splice:
        splice.apply(lines)
    return "\n".join(lines)


def test_an_edit_is_one_line():
    old = scene()
    new = old.replace(old.spheres[0], diameter=3.0)
    assert difference(old, new) == Splice(4, 1, ["sp 0,0,0 3 255,0,0"])


def test_versions_without_a_difference_have_no_splice():
    assert difference(scene(), scene()) is not None  # other items, though equal ones
    same = scene()
    assert difference(same, same) is None


@given(
    st.integers(1, 3000),
    st.lists(st.tuples(st.integers(0, 10**6), st.sampled_from(["change", "delete", "duplicate"])), max_size=8),
)
def test_any_edits_of_scenes_of_many_pages(spheres, edits):
    old = new = parse("A 0.2 255,255,255\nC 0,0,0 0,0,1 70\n" + "sp 0,0,9 1 1,2,3\n" * spheres, "scene.rt").scene
    for index, edit in edits:
        if not new.spheres:
            break
        sphere = new.spheres[index % len(new.spheres)]
        position = next(n for n, each in enumerate(new.elements) if each is sphere)
        changed = {"change": [sphere.replace(diameter=2.0 + index)], "delete": [], "duplicate": [sphere, sphere]}
        new = new.edit(position, *changed[edit])
    assert spliced(old, new) == dump(new)
    assert spliced(new, old) == dump(old)


@pytest.mark.parametrize("splice", [Splice(8, 3, []), Splice(-1, 1, []), Splice(3, -1, [])])
def test_lines_that_are_not_there_are_refused(splice):
    with pytest.raises(ValueError, match="lines that the file does not have"):
        splice.apply(TEXT.split("\n"))

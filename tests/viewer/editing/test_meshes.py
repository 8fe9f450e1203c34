"""Meshes in the viewer: added, selected, moved, resized, undone, saved, and replaced by other files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from minirt.scene import Camera, load
from minirt.shapes.mesh import Mesh
from minirt.viewer.app.replay import play
from minirt.viewer.app.session import Session
from minirt.viewer.display.outline import outline_pixels
from minirt.viewer.editing.adding import addable_kinds
from minirt.viewer.editing.editor import apply
from minirt.viewer.editing.state import initial_state
from tests.meshes.examples import named
from tests.viewer.display.test_marks import HEIGHT, WIDTH, edges, mask_of
from tests.viewer.fake import FakeRenderer

BARE = "A 0.2 255,255,255\nC 0,2,-20 0,0,1 60\n"
TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A scene file with two meshes beside it, one of them in a folder."""
    (tmp_path / "more").mkdir()
    (tmp_path / "a.obj").write_text(TETRAHEDRON)
    (tmp_path / "more" / "b.obj").write_text(TETRAHEDRON.replace("1", "2", 1))
    (tmp_path / "bad.obj").write_text("no mesh")
    scene = tmp_path / "scene.rt"
    scene.write_text(BARE + "ob a.obj 0,2,0 4 90,90,200\n")
    return scene


def played(path: Path, *lines: str) -> Session:
    """The session after these recorded keys."""
    return play(load(path).scene, lines, renderer=FakeRenderer(), size=(64, 48), path=path)


def test_a_mesh_is_one_selectable_element_and_one_line(path: Path) -> None:
    session = played(path, "press Tab")
    assert type(session.state.element) is Mesh
    moved = played(path, "press Tab", "press d", "press +", "press Ctrl+S")
    line = path.read_text().splitlines()[2].split()
    assert line[:2] == ["ob", "a.obj"]
    assert line[2] != "0,2,0"
    assert float(line[3]) == pytest.approx(4 * 1.05, rel=0.01)
    assert load(path).scene.items == moved.state.scene.items


def test_all_changes_of_a_mesh_are_undone(path: Path) -> None:
    state = initial_state(load(path).scene)
    start = state = state.select(len(state.scene.elements) - 1)
    for number, action in enumerate(("left", "grow", "next value", "grow")):
        state = apply(state, action, now=10.0 * number)
    assert state.scene != start.scene
    for _ in range(3):
        state = apply(state, "undo")
    assert state.scene == start.scene
    assert state.scene.shapes[0].parts == 4


def test_the_size_comes_before_the_file_and_the_file_can_be_changed(path: Path) -> None:
    state = initial_state(load(path).scene)
    state = state.select(len(state.scene.elements) - 1)
    names = []
    for _ in range(3):
        names.append(state.active.field.name)
        state = apply(state, "next value")
    assert names[0] == "scale"
    while state.active.field.name != "file":
        state = apply(state, "next value")
    for action, name in (("grow", "more/b.obj"), ("grow", "a.obj"), ("shrink", "more/b.obj")):
        state = apply(state, action)
        assert state.element.file.name == name
    assert state.element.bounds()[1][0] != 4


def test_a_single_mesh_file_cannot_be_changed(path: Path) -> None:
    (path.parent / "more" / "b.obj").unlink()
    state = initial_state(load(path).scene)
    state = state.select(len(state.scene.elements) - 1)
    while state.active.field.name != "file":
        state = apply(state, "next value")
    assert "no other mesh" in apply(state, "grow").message


def test_a_mesh_can_be_added_if_there_is_a_mesh_file(path: Path) -> None:
    scene = load(path).scene
    count = len(addable_kinds(scene))
    assert addable_kinds(scene)[-1] is Mesh
    session = played(path, *["press N"] * count)
    assert type(session.state.element) is Mesh
    assert len(session.state.scene.meshes) == 2
    for each in path.parent.rglob("*.obj"):
        each.unlink()
    assert Mesh not in addable_kinds(scene)
    assert len(addable_kinds(scene)) == count - 1


@pytest.mark.parametrize("name", ["icosahedron", "knot"])
def test_the_outline_of_a_mesh_is_its_silhouette(name: str) -> None:
    shape, camera = named(name, (0.5, 0.2, 0), 2.0), Camera((1, 2, -6), (-0.1, -0.3, 0.9), 70)
    for found, known in zip(outline_pixels(shape, camera, WIDTH, HEIGHT, 100), edges(shape, camera), strict=True):
        assert np.array_equal(mask_of(found), known)
        assert known.sum() > 50

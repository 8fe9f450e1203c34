"""Keys and mouse at random: no error, nothing lost, no memory that grows."""

from __future__ import annotations

import random
from itertools import islice

import pytest

from minirt.scene import Camera, dump, parse
from minirt.viewer.editing.state import State
from tests.viewer import monkey
from tests.viewer.fake import played

HELD = 40e6  # bytes: what may come with pictures of other sizes


@pytest.mark.parametrize("seed", range(4))
def test_in_memory(seed: int, tmp_path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(monkey.TEXT)
    acts = (line for line in monkey.lines(random.Random(seed)) if line not in monkey.FULL_SCREEN)
    lines = [*islice(acts, 300), "show", "up Shift", "wait 0"]
    states: list[State] = []  # whenever time has gone by
    undone = played(
        *lines,
        *["press Ctrl+Z"] * 400,
        text=monkey.TEXT,
        path=path,
        watch=lambda session: states.append(session.state),
    ).state
    scene = states[-1].scene  # before anything was undone
    assert sum(isinstance(each, Camera) for each in scene.elements) == 1
    assert parse(dump(scene)).scene.items == scene.items
    parse(path.read_bytes(), path)
    assert undone.undo_stack == ()
    assert undone.scene.items == parse(monkey.TEXT).scene.items


@pytest.mark.window
def test_in_a_window(desktop, tmp_path) -> None:
    found = monkey.play(desktop, lambda done: done / 180, 1, tmp_path)
    assert (found.status, found.errors) == (0, "")
    assert found.after < found.before + HELD
    assert found.lines >= 180


@pytest.mark.window
def test_in_a_window_that_fills_the_screen_now_and_then(desktop, tmp_path) -> None:
    found = monkey.play(desktop, lambda done: done / 105, 2, tmp_path)
    assert (found.status, found.errors) == (0, "")
    assert found.full_screens >= 2

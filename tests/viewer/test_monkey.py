"""Keys and mouse at random: no error, nothing lost, no memory that grows."""

from __future__ import annotations

import random
from itertools import islice

import pytest

from minirt.scene import Camera, dump, parse
from tests.viewer import monkey
from tests.viewer.fake import played

HELD = 40e6  # bytes: what may come with pictures of other sizes


@pytest.mark.parametrize("seed", range(4))
def test_in_memory(seed: int, tmp_path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(monkey.TEXT)
    acts = (line for line in monkey.lines(random.Random(seed)) if line not in monkey.FULL_SCREEN)
    lines = [*islice(acts, 300), "show", "up Shift"]
    session = played(*lines, text=monkey.TEXT, path=path)
    scene = session.state.scene
    assert sum(isinstance(each, Camera) for each in scene.elements) == 1
    assert parse(dump(scene)).scene.items == scene.items
    parse(path.read_bytes(), path)
    undone = played(*lines, *["press Ctrl+Z"] * 400, text=monkey.TEXT, path=path).state
    assert undone.past == ()
    assert undone.scene.items == parse(monkey.TEXT).scene.items


@pytest.mark.window
def test_in_a_window(desktop, tmp_path) -> None:
    found = monkey.play(desktop, 8.0, 1, tmp_path)
    assert (found.status, found.errors) == (0, "")
    assert found.after < found.before + HELD
    assert found.lines > 60

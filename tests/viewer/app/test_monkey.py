"""Monkey tests: random keys and mouse events cause no error, lose nothing and leak no memory."""

from __future__ import annotations

import random
from itertools import islice

import pytest

from minirt.scene import Camera, dump, parse
from minirt.viewer.editing.state import State
from tests.seeds import seed_of
from tests.viewer import monkey
from tests.viewer.fake import WITH_CYLINDER, played

MAX_GROWTH = 40e6  # bytes: pictures of other sizes may need them


def test_random_input_in_memory_loses_nothing(tmp_path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(WITH_CYLINDER)
    lines = [*islice(monkey.lines(random.Random(seed_of("monkey"))), 300), "show", "up Shift", "wait 0"]
    states: list[State] = []  # at each tick
    undone = played(
        *lines,
        *["press Ctrl+Z"] * 400,
        text=WITH_CYLINDER,
        path=path,
        watch=lambda session: states.append(session.state),
    ).state
    scene = states[-1].scene  # before anything was undone
    assert sum(type(each) is Camera for each in scene.elements) == 1
    assert parse(dump(scene), path).scene.items == scene.items
    parse(path.read_bytes(), path)
    assert undone.undo_stack == ()
    assert undone.scene.items == parse(WITH_CYLINDER).scene.items
    assert dump(undone.scene) == WITH_CYLINDER


@pytest.mark.window
def test_random_input_in_a_window_causes_no_error_and_no_leak(desktop, tmp_path) -> None:
    report = monkey.run_monkey(desktop, lambda done: done / 60, 1, tmp_path)
    assert (report.status, report.errors) == (0, "")
    before, after = report.record.ends
    assert after.memory < before.memory + MAX_GROWTH
    assert report.lines >= 60

"""Turntables and films, as the program writes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from tests.cli.program import TELLING, Ended, interrupt, start
from tests.cli.telling import RENDERING
from tests.terminals import terminal

Run = Callable[..., Ended]


def test_a_turntable_begins_with_the_picture(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--turntable", "3", "-o", "spin.png", "--size", "32x18") == (0, b"", "")
    names = ["spin-0001.png", "spin-0002.png", "spin-0003.png"]
    assert sorted(file.name for file in folder.glob("spin*")) == names
    first, second, _ = (np.asarray(pillow.open(folder / name)) for name in names)
    assert np.array_equal(first, minirt.render(minirt.load(folder / "ball.rt"), 32, 18).array)
    assert not np.array_equal(first, second)


def test_a_turntable_in_one_file(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--turntable", "5", "-o", "spin.GIF", "--size", "32x18").status == 0
    with pillow.open(folder / "spin.GIF") as found:
        assert (found.n_frames, found.size) == (5, (32, 18))


@pytest.mark.parametrize("wrong", [("--turntable", "3"), ("--turntable", "3", "-o", "-"), ("--turntable", "0")])
def test_where_to_is_asked_for(run: Run, wrong: tuple[str, ...]) -> None:
    ended = run("ball.rt", *wrong)
    assert (ended.status, ended.out) == (2, b"")
    assert "--turntable" in ended.err


def test_a_replay_becomes_a_film(run: Run, folder: Path) -> None:
    (folder / "keys.txt").write_text("press I\npress I\nhold d 1\nwait 0.2\n")
    assert run("ball.rt", "--replay", "keys.txt", "-o", "film.gif", "--size", "32x18").status == 0
    with pillow.open(folder / "film.gif") as found:
        assert found.n_frames > 8


@pytest.mark.parametrize("name", ["spin.gif", "spin.png"])
def test_an_interrupt_leaves_no_half_file(folder: Path, name: str) -> None:
    """In the third of many pictures."""
    arguments = "ball.rt", "-o", name, "--turntable", "3600", "--size", "640x360", "--samples", "64", "--threads", "1"
    with terminal() as told, start(folder, *arguments, command=TELLING, stderr=told.end) as process:
        told.leave()
        told.wait_for(b"picture 2 of 3600")
        told.wait_for(RENDERING)
        assert interrupt(process, told) == (130, b"")
    assert b"Traceback" not in told.text
    written = [file for file in folder.iterdir() if file.name != "ball.rt"]
    assert {file.name for file in written} >= ({"spin-0001.png", "spin-0002.png"} if name == "spin.png" else set())
    assert all(file.name.startswith("spin-") for file in written)
    assert bool(written) == (name == "spin.png")
    for file in written:
        with pillow.open(file) as found:
            found.load()

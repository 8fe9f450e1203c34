"""The program writes turntables and replays as movies."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

import minirt
from tests.cli.announcing import RENDERING
from tests.cli.program import ANNOUNCING, Result, interrupt, start
from tests.terminals import terminal
from tests.waiting import until

Run = Callable[..., Result]


def test_a_turntable_begins_with_the_view_of_the_scene(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--turntable", "3", "-o", "spin.png", "--size", "32x18") == (0, b"", "")
    names = ["spin-0001.png", "spin-0002.png", "spin-0003.png"]
    assert sorted(file.name for file in folder.glob("spin*")) == names
    first, second, _ = (np.asarray(pillow.open(folder / name)) for name in names)
    assert np.array_equal(first, minirt.render(minirt.load(folder / "ball.rt"), 32, 18).array)
    assert not np.array_equal(first, second)


def test_a_turntable_can_be_one_gif(run: Run, folder: Path) -> None:
    assert run("ball.rt", "--turntable", "5", "-o", "spin.GIF", "--size", "32x18").status == 0
    with pillow.open(folder / "spin.GIF") as movie:
        assert (movie.n_frames, movie.size) == (5, (32, 18))


@pytest.mark.parametrize("wrong", [("--turntable", "3"), ("--turntable", "3", "-o", "-"), ("--turntable", "0")])
def test_a_turntable_needs_a_number_and_a_file(run: Run, wrong: tuple[str, ...]) -> None:
    ended = run("ball.rt", *wrong)
    assert (ended.status, ended.out) == (2, b"")
    assert "--turntable" in ended.err


def test_a_replay_can_be_a_gif(run: Run, folder: Path) -> None:
    (folder / "keys.txt").write_text("press I\npress I\nhold d 1\nwait 0.2\n")
    assert run("ball.rt", "--replay", "keys.txt", "-o", "movie.gif", "--size", "32x18").status == 0
    with pillow.open(folder / "movie.gif") as movie:
        assert movie.n_frames > 8


@pytest.mark.parametrize("name", ["spin.gif", "spin.png"])
def test_an_interrupt_leaves_no_half_file(folder: Path, name: str) -> None:
    """The interrupt comes in the third of many pictures."""
    arguments = "ball.rt", "-o", name, "--turntable", "3600", "--size", "640x360", "--samples", "64", "--threads", "1"
    with terminal() as screen, start(folder, *arguments, command=ANNOUNCING, stderr=screen.end) as process:
        screen.leave()
        until(lambda: re.search(rb"picture ([3-9]|\d\d+) of 3600", screen.read()), "the third picture")
        screen.wait_for(RENDERING)
        assert interrupt(process, screen) == (130, b"")
    assert b"Traceback" not in screen.text
    assert b"--threads 1 --resume goes on" in screen.text
    assert (folder / f".{name}.journal").exists()
    written = [file for file in folder.iterdir() if file.name not in ("ball.rt", f".{name}.journal")]
    assert {file.name for file in written} >= ({"spin-0001.png", "spin-0002.png"} if name == "spin.png" else set())
    assert all(file.name.startswith("spin-") for file in written)
    assert bool(written) == (name == "spin.png")
    for file in written:
        with pillow.open(file) as movie:
            movie.load()

"""A scene may come from standard input."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import minirt
from tests.cli.program import SCENE, Result
from tests.cli.test_output import pixels

Run = Callable[..., Result]


@pytest.fixture
def give(monkeypatch: pytest.MonkeyPatch) -> Callable[[bytes], None]:
    """A function that sets standard input."""
    return lambda data: monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))


def test_a_scene_on_standard_input_is_rendered(run: Run, folder: Path, give: Callable[[bytes], None]) -> None:
    give(SCENE.encode())
    ended = run("-", "-o", "-", "--size", "40x30")
    assert (ended.status, ended.err) == (0, "")
    assert (pixels(ended.out) == minirt.render(minirt.load("ball.rt"), 40, 30).array).all()
    give(SCENE.encode())
    assert run("-", "-o", "{name}.png", "--size", "40x30").status == 0
    assert (folder / "stdin.png").exists()


def test_errors_name_standard_input(run: Run, give: Callable[[bytes], None]) -> None:
    give(SCENE.encode() + b"spp 0,0,0 1 1,2,3\n")
    ended = run("-", "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert ended.err.startswith("Error\nstandard input:6:1: unknown element 'spp', did you mean 'sp'?\n")
    give(b"")
    assert run("-", "--check").err == "Error\nstandard input: is empty\n"


@pytest.mark.parametrize("arguments", [("-",), ("-", "-", "--check"), ("-", "--replay", "x", "-o", "x.png")])
def test_a_window_and_a_second_reading_are_refused(run: Run, arguments: tuple[str, ...]) -> None:
    ended = run(*arguments)
    assert (ended.status, ended.err) == (
        2,
        "Error\na scene on standard input needs -o or --check, and is read once\n",
    )


def test_standard_input_that_is_closed_is_an_error(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    closed = io.TextIOWrapper(io.BytesIO())
    closed.close()
    monkeypatch.setattr(sys, "stdin", closed)
    with pytest.raises(ValueError, match="closed"):
        sys.stdin.buffer.read()
    ended = run("-", "--check")
    assert (ended.status, ended.err) == (1, "Error\nstandard input: cannot be read: it is closed\n")

"""Example scenes on the command line, and the program without arguments."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image as pillow  # noqa: N813

import minirt
from minirt.cli import argument_parser, files
from tests.cli.program import Result, program
from tests.paths import SCENES

Run = Callable[..., Result]


def test_the_program_without_arguments_renders_the_demo_where_no_window_is(folder: Path) -> None:
    ended = program(folder)
    assert (ended.status, ended.err) == (0, "")
    assert str(folder / files.DEMO_PICTURE) in ended.out.decode()
    with pillow.open(folder / files.DEMO_PICTURE) as picture:
        shown = np.asarray(picture)
    expected = minirt.render(minirt.load(SCENES / "demo.rt")).array
    assert np.array_equal(shown, expected)
    assert not np.array_equal(shown, minirt.render(minirt.example("shapes")).array)


def test_an_example_is_rendered_wherever_the_program_runs(run: Run, folder: Path) -> None:
    assert run("--example", "meshes", "-o", "meshes.png", "--size", "64x36").status == 0
    with pillow.open(folder / "meshes.png") as picture:
        assert np.array_equal(np.asarray(picture), minirt.render(minirt.load(SCENES / "meshes.rt"), 64, 36).array)


def test_an_unknown_example_is_an_error_that_names_what_is_like_it(run: Run) -> None:
    ended = run("--example", "galery-sea", "--check")
    assert (ended.status, ended.out) == (1, b"")
    assert "did you mean gallery-sea" in ended.err
    assert "the examples are camera-lens, demo, " in run("--example", "?", "--check").err


def test_an_example_beside_a_scene_is_refused(run: Run) -> None:
    ended = run("ball.rt", "--example")
    assert ended.status == 2
    assert "got ball.rt, too" in ended.err


def test_the_window_saves_an_example_to_a_new_file(folder: Path) -> None:
    parser = argument_parser()
    for name in ("demo.rt", "demo-1.rt", "demo-2.rt"):
        options = parser.parse_args(["--example"])
        files.choose_example(parser, options, ["--example"])
        assert options.scene == [name]
        (folder / name).write_text("kept")

"""Example scenes of the command line: `--example [NAME]`, and the demo of a program without arguments."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING

from minirt.cli.arguments import DEMO, Arguments

if TYPE_CHECKING:
    from minirt.scene import Scene

DEMO_PICTURE = "miniRT-demo.png"  # of a program without arguments, where no window can be opened


def choose(parser: Arguments, options: argparse.Namespace, arguments: Sequence[str]) -> None:
    """Let an example stand for the scene file where the options ask for one, or where there are no arguments.

    The window saves it to a new file in the current folder.
    """
    if not arguments:
        options.example, options.fallback = DEMO, DEMO_PICTURE
    if not options.example:
        return
    from pathlib import Path

    if options.scene:
        parser.error(f"--example shows a scene of its own, got {options.scene[0]}, too")
    names = (f"{options.example}{suffix}.rt" for suffix in ("", *(f"-{number}" for number in range(1, 1000))))
    options.scene = [next((name for name in names if not Path(name).exists()), f"{options.example}.rt")]


def read(options: argparse.Namespace) -> Scene:
    """Return the example; FileError for an unknown name."""
    from minirt import example

    scene = example(options.example)
    return scene.replace(scene.camera, left_handed=True) if options.left_handed else scene

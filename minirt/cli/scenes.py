"""Scenes that the command line names: files, pictures that carry one, standard input and examples."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, TextIO

from minirt.cli.arguments import DEMO, Arguments
from minirt.cli.output import tell
from minirt.helpers.progress import progress

if TYPE_CHECKING:
    from minirt.scene import Reading, Scene

DEMO_PICTURE = "miniRT-demo.png"  # of a program without arguments, where no window can be opened
STANDARD_INPUT = "standard input"


def read_scene(options: argparse.Namespace, stream: TextIO) -> Scene:
    """Load the scene; print its notices, one for each tolerated mistake, to `stream`."""
    from minirt.scene import load

    if options.example:
        return read_example(options)
    from minirt.helpers.progress import State

    path = options.scene[0]
    with progress(lambda: State(f"reading {STANDARD_INPUT if path == '-' else path}")):
        scene, notices = (
            read_standard_input(options) if path == "-" else load(path, options.lenient, options.left_handed)
        )
    for notice in notices:
        tell(f"notice: {notice}", stream)
    return scene


def read_standard_input(options: argparse.Namespace) -> Reading:
    """Parse standard input; pictures and meshes are looked for in the current folder. SceneError."""
    from minirt.scene import Reading, parse
    from minirt.scene.files import MAX_BYTES, file_error

    try:
        data = sys.stdin.buffer.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else None
        raise file_error(STANDARD_INPUT, f"cannot be read: {reason or 'it is closed'}") from None
    if len(data) > MAX_BYTES:
        raise file_error(STANDARD_INPUT, f"larger than {MAX_BYTES // 2**20} MiB")
    scene, notices = parse(data, STANDARD_INPUT, options.lenient)
    return Reading(with_handedness(scene, options), notices)


def with_handedness(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return the scene, mirrored if the options ask for it."""
    return scene.replace(scene.camera, left_handed=True) if options.left_handed else scene


def with_camera_options(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return the scene with the tone and the exposure that the options ask for."""
    given = {"tone": options.tone, "exposure": options.exposure}
    changes = {name: value for name, value in given.items() if value is not None}
    return scene.replace(scene.camera, **changes) if changes else scene


def choose_example(parser: Arguments, options: argparse.Namespace, arguments: Sequence[str]) -> None:
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


def read_example(options: argparse.Namespace) -> Scene:
    """Return the example; FileError for an unknown name."""
    from minirt import example

    scene = example(options.example)
    return scene.replace(scene.camera, left_handed=True) if options.left_handed else scene

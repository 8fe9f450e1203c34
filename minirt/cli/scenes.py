"""Reading the scenes that the command line names: files, pictures that carry a scene, and standard input."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, TextIO

from minirt.cli import example
from minirt.cli.output import tell
from minirt.helpers.progress import State, progress

if TYPE_CHECKING:
    from minirt.scene import Reading, Scene

STANDARD_INPUT = "standard input"


def read_scene(options: argparse.Namespace, stream: TextIO) -> Scene:
    """Load the scene; print its notices, one for each tolerated mistake, to `stream`."""
    from minirt import jail
    from minirt.scene import load

    if options.trust is not None:
        (jail.trust_all_files if options.trust else jail.trust_no_files)()
    if options.example:
        return example.read(options)
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

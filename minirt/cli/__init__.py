"""Command line of miniRT: parse the arguments, run the command, return an exit status.

This is the only place that prints errors. The commands are imported after the arguments are parsed, so that `--help`
and `--version` come at once.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, TextIO

from minirt.cli.arguments import Arguments, argument_parser
from minirt.cli.exit_status import FAILED, INTERRUPTED, OK, USAGE
from minirt.cli.output import hide_warnings, prepare_streams, say, tell
from minirt.errors import MiniRTError

if TYPE_CHECKING:
    from minirt.scene import Scene


def main(argv: Sequence[str] | None = None) -> int:
    """Run the program and return its exit status."""
    prepare_streams()
    if argv is None:  # a program of its own
        hide_warnings()
        leave_blas_single_threaded()
    try:
        return run(argument_parser(), argv)
    except MiniRTError as error:
        tell(f"Error\n{error}")
        return FAILED
    except BrokenPipeError:  # the reader of standard output has closed it
        return FAILED
    except KeyboardInterrupt:
        return INTERRUPTED


def leave_blas_single_threaded() -> None:
    """Let numpy's OpenBLAS start no threads, unless the user asks for some; to be called before numpy is imported.

    They would spin for 20 to 40 ms of the start, and the program multiplies only small matrices.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def run(parser: Arguments, argv: Sequence[str] | None) -> int:
    """Parse the arguments and run the command that they select."""
    options = parser.parse_args(argv)
    if options.version or options.list_keys:
        say(version() if options.version else keys())
        return OK
    check_options(parser, options)
    from minirt.gc_pause import gc_paused

    with gc_paused():  # looking for garbage among new modules takes an eighth of a warm start
        from minirt.cli.commands import command_for
        from minirt.cli.window import show

        command = command_for(options)
        # A picture may go to standard output. A window leaves it free, and standard error stays empty without errors.
        scene = read_scene(options, sys.stdout if command is show else sys.stderr)
    if command is show:  # which compares what it shows with the file
        return show(with_camera_options(scene, options), options, scene)
    return command(with_camera_options(scene, options), options)


def check_options(parser: Arguments, options: argparse.Namespace) -> None:
    """Exit with a message when the options do not go together; RenderError for an unknown picture format."""
    if len(options.scene) != 1:
        found = f"{len(options.scene)}: {' '.join(options.scene)}".rstrip(": ")
        parser.fail(f"expected one scene file, got {found}", FAILED)
    if options.output and options.output != "-":
        from minirt.image import format_of

        format_of(options.output)  # before the work, not after it
    if options.turntable and options.output in (None, "-"):
        parser.error("--turntable needs the name of a file: -o spin.gif")
    if (options.error or options.time) and options.samples != "auto":
        parser.fail("--error and --time need --samples auto", USAGE)
    if options.strict and not options.error:
        parser.fail("--strict needs --error", USAGE)
    if options.samples == "auto" and (options.replay or options.turntable or not options.output):
        parser.fail("--samples auto makes one picture: it needs -o, and no --replay or --turntable", USAGE)


def version() -> str:
    """Return the program's name and version."""
    from minirt import __version__

    return f"miniRT {__version__}"


def keys() -> str:
    """Return the table of the window's key bindings."""
    from minirt.viewer import keys_text

    return keys_text()


def with_camera_options(scene: Scene, options: argparse.Namespace) -> Scene:
    """Return the scene with the tone and the exposure that the options ask for."""
    given = {"tone": options.tone, "exposure": options.exposure}
    changes = {name: value for name, value in given.items() if value is not None}
    return scene.replace(scene.camera, **changes) if changes else scene


def read_scene(options: argparse.Namespace, stream: TextIO) -> Scene:
    """Load the scene file; print its notices, one for each tolerated mistake, to `stream`."""
    from minirt.scene import load

    scene, notices = load(options.scene[0], options.lenient, options.left_handed)
    for notice in notices:
        tell(f"notice: {notice}", stream)
    return scene

"""The arguments that the program understands."""

from __future__ import annotations

import argparse
from typing import NoReturn

from minirt import DEFAULT_ERROR
from minirt.cli.argument_values import above_0, size, whole

USAGE = 2  # status: wrong arguments
SAMPLES, WINDOW_SAMPLES = 1, 16  # where none are asked for
DEPTH, DEEPEST = 8, 32  # the same of bounces, and the most that there may be


class Arguments(argparse.ArgumentParser):
    """argparse, with `Error` as the first line of what it complains about."""

    def error(self, message: str) -> NoReturn:
        self.fail(message, USAGE)

    def fail(self, message: str, status: int) -> NoReturn:
        self.exit(status, f"Error\n{message}\n{self.format_usage()}")


def arguments() -> Arguments:
    """What the program understands."""
    parser = Arguments(prog="miniRT", description="Show a .rt scene in a window, or render it to a file.")
    parser.add_argument("scene", nargs="*", metavar="SCENE.rt", help="the scene file")
    add = parser.add_argument_group("output").add_argument
    add(
        "-o", "--output", metavar="FILE", help="render to a picture file instead of a window; - is standard output, PNG"
    )
    add("--size", type=size, metavar="WxH", help="size of the picture in pixels")
    add(
        "--samples",
        type=lambda text: text if text == "auto" else whole(text, 1, 65536),
        metavar="N",
        help=f"rays for each pixel ({SAMPLES}), or auto: where they are needed; "
        f"in the window at edges, when nothing moves ({WINDOW_SAMPLES})",
    )
    add(
        "--turntable",
        type=lambda text: whole(text, 1, 3600),
        metavar="N",
        help="with -o: N pictures from all around the scene; spin.gif is one file, spin.png is spin-0001.png, ...",
    )
    add(
        "--error",
        type=above_0,
        metavar="E",
        help=f"with --samples auto: until the estimated error is E ({DEFAULT_ERROR})",
    )
    add("--time", type=above_0, metavar="SECONDS", help="with --samples auto: until that time has passed")
    add("--fallback", metavar="FILE", help="render to FILE where no window can be opened")
    add("--left-handed", action="store_true", help="mirror the picture, for scenes of programs with such coordinates")
    add = parser.add_argument_group("window").add_argument
    add("--keys", choices=("auto", "qwerty", "azerty", "qwertz"), default="auto", help="the layout of the keyboard")
    add("--watch", action=argparse.BooleanOptionalAction, default=True, help="read the scene again when it changes")
    add("--replay", metavar="KEYS.txt", help="play recorded keys without a window; -o takes the last frame, a .gif all")
    add = parser.add_argument_group("inspect").add_argument
    add("--check", action="store_true", help="read the scene, report what is wrong with it, make no picture")
    add("--lenient", action="store_true", help="read what older scenes have: several L, blanks around commas, ...")
    add("--bench", action="store_true", help="measure the time of a frame")
    add("--json", action="store_true", help="with --bench: as JSON")
    add("--report", metavar="DIR", help="measure error against run time; tables, pictures and a diagram go into DIR")
    add("--quick", action="store_true", help="with --report: smaller pictures, fewer rays, some seconds")
    add("--list-keys", action="store_true", help="list the keys of the window")
    add("--threads", type=lambda text: whole(text, 1, 1024), metavar="N", help="threads that render")
    add("--precision", choices=("double", "single"), default="double", help="of the numbers that pictures are made of")
    add("--depth", type=lambda text: whole(text, 0, DEEPEST), metavar="N", help=f"bounces of light, at most ({DEPTH})")
    add("-v", "--verbose", action="store_true", help="say what is done, and how long it takes")
    add("--version", action="store_true", help="print the version")
    return parser

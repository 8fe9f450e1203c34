"""Arguments of the command line, with their help texts and defaults."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn

from minirt import DEFAULT_ERROR
from minirt.cli.argument_values import exposure, positive_number, size, whole_number
from minirt.cli.exit_status import USAGE
from minirt.cli.output import say, tell

SAMPLES, WINDOW_SAMPLES = 1, 16  # default samples a pixel: of a file, of the window
TONES = ("plain", "srgb", "filmic")
DEPTH, MAX_DEPTH = 8, 32  # bounces of light: default and limit


class Arguments(argparse.ArgumentParser):
    """Argument parser whose error messages begin with a line `Error`."""

    def error(self, message: str) -> NoReturn:
        """Exit with the status for wrong arguments; argparse calls this."""
        self.fail(message, USAGE)

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print a help text or an error; argparse calls this, and would not notice that it cannot be written."""
        if file is sys.stdout:
            say(message, end="")
        else:
            tell(message.rstrip("\n"))

    def fail(self, message: str, status: int) -> NoReturn:
        """Print the message and the usage to standard error, and exit with `status`."""
        self.exit(status, f"Error\n{message}\n{self.format_usage()}")


def argument_parser() -> Arguments:
    """Return the parser of the command line."""
    parser = Arguments(prog="miniRT", description="Show a .rt scene in a window, or render it to a file.")
    parser.add_argument("scene", nargs="*", metavar="SCENE.rt", help="the scene file")
    add = parser.add_argument_group("output").add_argument
    add(
        "-o",
        "--output",
        metavar="FILE",
        help="render to a picture file instead of a window; - writes PNG to standard output",
    )
    add("--size", type=size, metavar="WxH", help="size of the picture in pixels")
    add(
        "--samples",
        type=lambda text: text if text == "auto" else whole_number(text, 1, 65536),
        metavar="N",
        help=f"rays for each pixel ({SAMPLES}), or auto: as many as each part of the picture needs; "
        f"in the window: rays at edges while nothing moves ({WINDOW_SAMPLES})",
    )
    add(
        "--turntable",
        type=lambda text: whole_number(text, 1, 3600),
        metavar="N",
        help="with -o: N pictures from all around the scene; spin.gif is one file, spin.png is spin-0001.png, ...",
    )
    add(
        "--error",
        type=positive_number,
        metavar="E",
        help=f"with --samples auto: sample until the estimated error is at most E ({DEFAULT_ERROR})",
    )
    add("--time", type=positive_number, metavar="SECONDS", help="with --samples auto: sample for that long")
    add(
        "--strict",
        action="store_true",
        help="exit with status 1 when the picture has not reached the error that --error asks for",
    )
    add("--tone", choices=TONES, help="how light becomes colour, in place of the camera's tone (plain)")
    add("--exposure", type=exposure, metavar="EV", help="light times two to this power, in place of the camera's (0)")
    add("--dither", action="store_true", help="dither with blue noise instead of rounding to 8 bits")
    add("--fallback", metavar="FILE", help="render to FILE when no window can be opened")
    add("--left-handed", action="store_true", help="mirror the picture, for scenes made for left-handed coordinates")
    add = parser.add_argument_group("window").add_argument
    add("--keys", choices=("auto", "qwerty", "azerty", "qwertz"), default="auto", help="layout of the keyboard")
    add(
        "--watch",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="reload the scene when its file changes",
    )
    add(
        "--replay",
        metavar="KEYS.txt",
        help="play recorded keys without a window; -o writes the last frame, or all frames to a .gif",
    )
    add = parser.add_argument_group("inspect").add_argument
    add("--check", action="store_true", help="read the scene and report its errors; render nothing")
    add("--lenient", action="store_true", help="accept older scenes: several L, blanks around commas, ...")
    add("--bench", action="store_true", help="measure the frame time: of an eye at rest, and of a moving one")
    add("--json", action="store_true", help="with --bench: print JSON")
    add("--report", metavar="DIR", help="measure error against run time; write tables, pictures and a diagram into DIR")
    add("--quick", action="store_true", help="with --report: smaller pictures and fewer rays; takes seconds")
    add(
        "--ablation", action="store_true", help="with --report: also what each absent feature would cost; takes minutes"
    )
    add("--list-keys", action="store_true", help="list the key bindings of the window")
    add(
        "--threads",
        type=lambda text: whole_number(text, 1, 1024),
        metavar="N",
        help="number of rendering threads (one for each processor)",
    )
    add(
        "--precision",
        choices=("double", "single"),
        default="double",
        help="floating-point precision of the kernel (double)",
    )
    add(
        "--depth",
        type=lambda text: whole_number(text, 0, MAX_DEPTH),
        metavar="N",
        help=f"largest number of reflections and refractions of a ray ({DEPTH})",
    )
    add("-v", "--verbose", action="store_true", help="report each step and its duration")
    add("--version", action="store_true", help="print the version")
    return parser

"""Arguments of the command line, with their help texts and defaults."""

from __future__ import annotations

import argparse
import sys
from typing import Any, NoReturn

from minirt import DEFAULT_ERROR
from minirt.cli.argument_values import (
    cluster,
    exposure,
    file_name,
    memory_size,
    positive_number,
    region,
    size,
    span,
    text_scale,
    whole_number,
)
from minirt.cli.exit_status import USAGE
from minirt.cli.output import say, tell

SAMPLES, WINDOW_SAMPLES = 1, 16  # default samples a pixel: of a file, of the window
DEMO = "demo"  # the example scene of a program without arguments
TONES = ("plain", "srgb", "filmic")
DEPTH, MAX_DEPTH = 8, 32  # bounces of light: default and limit


class Arguments(argparse.ArgumentParser):
    """Argument parser whose error messages begin with a line `Error`."""

    def error(self, message: str) -> NoReturn:
        """Print one sentence to standard error, and exit with the status for wrong arguments; argparse calls this."""
        from minirt.cli.suggestions import clearer

        self.exit(USAGE, f"Error\n{clearer(self, message)}\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print a help text or an error; argparse calls this, and would not notice that it cannot be written."""
        if file is sys.stdout:
            say(message, end="")
        else:
            tell(message.rstrip("\n"))


def argument_parser() -> Arguments:
    """Return the parser of the command line."""
    parser = Arguments(prog="miniRT", description="Show a .rt scene in a window, or render it to a file.")
    parser.add_argument(
        "scene",
        type=file_name,
        nargs="*",
        metavar="SCENE.rt",
        help="the scene file, or a PNG picture of it; - for standard input",
    )
    parser.add_argument(
        "--example",
        nargs="?",
        const=DEMO,
        metavar="NAME",
        help=f"show an example scene ({DEMO}) that is installed with the program, in place of a scene file",
    )
    add = parser.add_argument_group("output").add_argument
    add(
        "-o",
        "--output",
        type=file_name,
        metavar="FILE",
        help="render to a picture file instead of a window: .png, .jpg, .webp, .tif, ..., or .exr, .hdr, .pfm for "
        "linear light; - writes PNG to standard output; out/{name}.png is for several scenes",
    )
    add("--size", type=size, metavar="WxH", help="size of the picture in pixels")
    add(
        "--region",
        type=region,
        metavar="X,Y,W,H",
        help="with -o: render this rectangle of the picture alone, at column X and row Y",
    )
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
        help="with -o: N pictures from all around the scene; .gif, .webp, .apng, .mp4 and .webm are one file, "
        "spin.png is spin-0001.png, ...",
    )
    add("--frames", type=span, metavar="A-B", help="with --turntable: only these of its pictures")
    add(
        "--resume",
        action="store_true",
        help="with -o: go on with what an interrupted program has left of the same picture or film",
    )
    add("--bits", type=int, choices=(8, 16), help="bits a channel of PNG and TIFF pictures (8)")
    add(
        "--quality",
        type=lambda text: whole_number(text, 1, 100),
        metavar="N",
        help="quality of lossy formats, from 1 to 100",
    )
    add(
        "--metadata",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="let a PNG picture carry its scene and settings: miniRT picture.png opens it again",
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
    add("--fallback", type=file_name, metavar="FILE", help="render to FILE when no window can be opened")
    add("--left-handed", action="store_true", help="mirror the picture, for scenes made for left-handed coordinates")
    add = parser.add_argument_group("window").add_argument
    add("--keys", choices=("auto", "qwerty", "azerty", "qwertz"), default="auto", help="layout of the keyboard")
    add(
        "--text-scale",
        type=text_scale,
        default=1.0,
        metavar="F",
        help="size of text and icons, from 0.5 to 4 times the usual one (Ctrl + and Ctrl - change it)",
    )
    add(
        "--watch",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="reload the scene when its file changes",
    )
    add(
        "--replay",
        type=file_name,
        metavar="KEYS.txt",
        help="play recorded keys without a window; -o writes the last frame, or all frames to a film such as .gif",
    )
    add = parser.add_argument_group("inspect").add_argument
    add("--check", action="store_true", help="read the scene and report its errors; render nothing")
    add("--lenient", action="store_true", help="accept older scenes: several L, blanks around commas, ...")
    add(
        "--trust",
        action=argparse.BooleanOptionalAction,
        help="decode all pictures in this process (--trust) or in a confined one (--no-trust); by default in this one "
        "those that were decoded well before",
    )
    add("--bench", action="store_true", help="measure the frame time: of an eye at rest, and of a moving one")
    add("--json", action="store_true", help="with --bench: print JSON")
    add(
        "--report",
        type=file_name,
        metavar="DIR",
        help="measure error against run time; write tables, pictures and a diagram into DIR",
    )
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
        "--memory",
        type=memory_size,
        metavar="SIZE",
        help="memory that the program may take, such as 512M or 4G: what needs more is refused (seven eighths of that "
        "of the machine or control group)",
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
    add(
        "--cluster",
        type=cluster,
        metavar="WHERE",
        help="with -o: render bands of the picture, or frames of --turntable, by several processes of this machine "
        "(local), or by the workers of a dask scheduler (tcp://host:8786); sizes may exceed 16384",
    )
    add("--config", metavar="FILE", help="file with defaults of options, in place of miniRT's own; '' for none")
    add("--completion", choices=("bash", "zsh", "fish"), help="print the completion of arguments for a shell")
    add("-v", "--verbose", action="store_true", help="report each step and its duration")
    add("--version", action="store_true", help="print the version")
    return parser

"""Arguments of the command line: options with their help texts and defaults, parsers of values, exit statuses.

A parser of a value raises ArgumentTypeError, which says what is wrong with a text.
"""

from __future__ import annotations

import argparse
import re
import sys
from argparse import ArgumentTypeError
from collections.abc import Callable, Sequence
from functools import partial
from math import nan
from typing import Any, NoReturn

from minirt.cli.output import say, tell
from minirt.errors import did_you_mean

OK = 0  # exit statuses
FAILED = 1  # an error in a scene, in rendering or in writing
USAGE = 2  # wrong arguments
INTERRUPTED = 130  # Ctrl+C; 128 + n after another signal n
SAMPLES, WINDOW_SAMPLES = 1, 16  # default samples a pixel: of a file, of the window
OPENING = "opening"  # the example scene of a program without arguments
DEPTH, MAX_DEPTH = 8, 32  # bounces of light: default and limit
MAX_SIDE = 16384  # pixels
MOST = 999_999_999  # pixels of a side that --cluster takes, if the format holds them
LEAST_MEMORY, MOST_MEMORY = 2**20, 2**50  # bytes
MAX_EXPOSURE = 20.0  # EV, up and down
MOST_NUMBER = sys.float_info.max
UNKNOWN = re.compile(r"unrecognized arguments: (-\S*)")
CHOICE = re.compile(r"argument (?P<option>.*?): invalid choice: '?(?P<value>.*?)'? \(choose from (?P<choices>.*)\)")
TEXT_SCALES = 0.5, 4.0  # least and largest, as with keys in the window


def file_name(text: str) -> str:
    """Check that the name of a file or folder is not empty."""
    if not text:
        raise ArgumentTypeError("must be the name of a file, got ''")
    return text


def numbers(text: str, sign: str, form: str, limits: Sequence[tuple[int, int]]) -> tuple[int, ...]:
    """Parse whole numbers in their limits with a sign between them, such as 640x480; `form` tells what is expected."""
    words = text.split(sign)
    if len(words) != len(limits) or not all(each.isascii() and each.isdigit() for each in words):
        raise ArgumentTypeError(f"must be {form}, got '{text[:40]}'")
    return tuple(whole_number(each, *limit) for each, limit in zip(words, limits, strict=True))


def cluster(text: str) -> str:
    """Parse the place of workers: local, or the address of a scheduler."""
    if text != "local" and not re.fullmatch(r"[a-z]+://[!-~]+", text):
        raise ArgumentTypeError(f"must be local, or the address of a scheduler like tcp://host:8786, got '{text[:40]}'")
    return text


def whole_number(text: str, low: int, high: int) -> int:
    """Parse a whole number in [low, high]."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high):
        raise ArgumentTypeError(f"must be a whole number from {low} to {high}, got '{text[:40]}'")
    return int(text)


def span(text: str) -> range:
    """Parse numbers of frames: 10-20, or 7 alone."""
    first, dash, last = text.partition("-")
    try:
        start = whole_number(first, 1, 3600)
        return range(start, whole_number(last, start, 3600) + 1 if dash else start + 1)
    except ArgumentTypeError:
        raise ArgumentTypeError(f"must be FIRST-LAST, like 10-20, got '{text[:40]}'") from None


def number(text: str, low: float = 5e-324, high: float = MOST_NUMBER) -> float:
    """Parse a number in [low, high]; without limits a finite one > 0."""
    try:
        result = float(text) if text.isascii() and "_" not in text else nan
    except ValueError:
        result = nan
    if not low <= result <= high:
        limits = "> 0" if high == MOST_NUMBER else f"from {low:g} to {high:g}"
        raise ArgumentTypeError(f"must be a number {limits}, got '{text[:40]}'")
    return result


def memory_size(text: str) -> int:
    """Parse an amount of memory in bytes, or in units of 1024 such as 512M, 1.5G and 2GiB."""
    match = re.fullmatch(r"([0-9]{1,15}(?:\.[0-9]{1,9})?)(?:([kmgt])(?:i?b)?)?", text.lower(), re.ASCII)
    size = int(float(match[1]) * 1024 ** (" kmgt".index(match[2]) if match[2] else 0)) if match else 0
    if not LEAST_MEMORY <= size <= MOST_MEMORY:
        raise ArgumentTypeError(f"must be an amount of memory from 1M to 1024T, like 512M or 4G, got '{text[:40]}'")
    return size


class Arguments(argparse.ArgumentParser):
    """Argument parser whose error messages begin with a line `Error`."""

    def error(self, message: str) -> NoReturn:
        """Print one sentence to standard error, and exit with the status for wrong arguments; argparse calls this."""
        self.exit(USAGE, f"Error\n{clearer(self, message)}\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print a help text or an error; argparse calls this, and would not notice that it cannot be written."""
        if file is sys.stdout:
            say(message, end="")
        else:
            tell(message.rstrip("\n"))


OPTIONS = f"""
output:
-o --output=FILE  render to a picture file instead of a window: .png, .jpg, .webp, .tif, ..., or .exr, .hdr, .pfm for
    linear light; - writes PNG to standard output; out/{{name}}.png is for several scenes
--size=WxH  size of the picture in pixels
--region=X,Y,W,H  with -o: render this rectangle of the picture alone, at column X and row Y
--samples=N  rays for each pixel ({SAMPLES}), or auto: as many as each part of the picture needs, 4096 at most;
    in the window: rays at edges while nothing moves ({WINDOW_SAMPLES})
--turntable=N  with -o: N pictures from all around the scene; .gif, .webp, .apng, .mp4 and .webm are one file, spin.png
    is spin-0001.png, ...
--frames=A-B  with --turntable: only these of its pictures
--resume  with -o: go on with what an interrupted program has left of the same picture or film
--bits={{8,16}}  bits a channel of PNG and TIFF pictures (8)
--quality=N  quality of lossy formats, from 1 to 100
--[no-]metadata  let a PNG picture carry its scene and settings: miniRT picture.png opens it again
--error=E  with --samples auto: sample until the estimated error is at most E (0.002)
--time=SECONDS  with --samples auto: sample for that long
--strict  exit with status 1 when the picture has not reached the error that --error asks for
--camera=N  camera of the picture and the window, in the order of the file (1)
--tone={{plain,srgb,filmic}}  how light becomes colour, in place of the camera's tone (plain)
--exposure=EV  light times two to this power, in place of the camera's (0)
--dither  dither with blue noise instead of rounding to 8 bits
--fallback=FILE  render to FILE when no window can be opened
--left-handed  mirror the picture, for scenes made for left-handed coordinates

window:
--keys={{auto,qwerty,azerty,qwertz}}  layout of the keyboard
--text-scale=F  size of text and icons, from 0.5 to 4 times the usual one (Ctrl + and Ctrl - change it)
--[no-]watch  reload the scene when its file changes
--replay=KEYS.txt  play recorded keys without a window; -o writes the last frame, or all frames to a film such as .gif

inspect:
--check  read the scene and report its errors; render nothing
--lenient  read scenes of older and of other programs, and say how
--cone={{base,angle}}  as --lenient, with cones whose point is the centre of the base, or that have half the angle at
    the apex in place of a diameter
--bench  measure the frame time: of an eye at rest, and of a moving one
--json  with --bench: print JSON
--report=DIR  measure error against run time; write tables, pictures and a diagram into DIR
--quick  with --report: smaller pictures and fewer rays; takes seconds
--ablation  with --report: also what each absent feature would cost; takes minutes
--list-keys  list the key bindings of the window
--threads=N  number of rendering threads (one for each processor)
--memory=SIZE  memory that the program may take, such as 512M or 4G: what needs more is refused (seven eighths of that
    of the machine or container)
--precision={{double,single}}  floating-point precision of the kernel (double)
--depth=N  largest number of reflections and refractions of a ray ({DEPTH})
--cluster=WHERE  with -o: render bands of the picture, or frames of --turntable, by several processes of this machine
    (local), or by the workers of a dask scheduler (tcp://host:8786); sizes may exceed {MAX_SIDE}
--config=FILE  file with defaults of options, in place of miniRT's own; '' for none
--completion={{bash,zsh,fish}}  print the completion of arguments for a shell
-v --verbose  report each step and its duration
--version  print the version
"""
# Defaults of options that are not off or unset without one.
DEFAULTS: dict[str, object] = {"keys": "auto", "text_scale": 1.0, "precision": "double", "camera": 1}
KINDS: dict[str, Callable[[str], object]] = {  # parsers of values that are more than a text
    **dict.fromkeys(("output", "fallback", "replay", "report"), file_name),
    **dict.fromkeys(("error", "time"), number),
    "size": partial(numbers, sign="x", form="WIDTHxHEIGHT, like 640x480", limits=[(1, MOST)] * 2),
    "region": partial(
        numbers, sign=",", form="X,Y,WIDTH,HEIGHT, like 320,0,640,480", limits=[(0, MAX_SIDE)] * 2 + [(1, MAX_SIDE)] * 2
    ),
    "samples": lambda text: text if text == "auto" else whole_number(text, 1, 65536),
    "turntable": partial(whole_number, low=1, high=3600),
    "frames": span,
    "bits": int,
    "quality": partial(whole_number, low=1, high=100),
    "exposure": partial(number, low=-MAX_EXPOSURE, high=MAX_EXPOSURE),
    "text_scale": partial(number, low=TEXT_SCALES[0], high=TEXT_SCALES[1]),
    "threads": partial(whole_number, low=1, high=1024),
    "memory": memory_size,
    "camera": partial(whole_number, low=1, high=9999),
    "depth": partial(whole_number, low=0, high=MAX_DEPTH),
    "cluster": cluster,
}


def argument_parser() -> Arguments:
    """Return the parser of the command line."""
    parser = Arguments(prog="miniRT", description="Show a .rt scene in a window, or render it to a file.")
    add = parser.add_argument
    scene_help = "the scene file, or a PNG picture of it; - for standard input"
    add("scene", type=file_name, nargs="*", metavar="SCENE.rt", help=scene_help)
    example_help = f"show an example scene ({OPENING}) that is installed with the program, in place of a scene file"
    add("--example", nargs="?", const=OPENING, metavar="NAME", help=example_help)
    for group in OPTIONS.strip().replace("\n    ", " ").split("\n\n"):
        title, *lines = group.split("\n")
        add = parser.add_argument_group(title.removesuffix(":")).add_argument
        for line in lines:
            usage, _, about = line.partition("  ")
            names, _, value = usage.partition("=")
            name = names.rpartition("--")[2].replace("-", "_")
            how: dict[str, Any] = {"action": "store_true"}
            if names.startswith("--[no-]"):
                names = names.replace("[no-]", "")
                how = {"action": argparse.BooleanOptionalAction, "default": True}
            elif value:
                kind = KINDS.get(name, str)
                how = {"type": kind, "default": DEFAULTS.get(name)}
                listed = value.startswith("{")
                how |= {"choices": [kind(each) for each in value[1:-1].split(",")]} if listed else {"metavar": value}
            add(*names.split(), help=about, **how)
    return parser


def clearer(parser: argparse.ArgumentParser, message: str) -> str:
    """Return the message of argparse about wrong arguments, in one line and with a suggestion."""
    if unknown := UNKNOWN.match(message):
        word = unknown[1].partition("=")[0]
        options = [option for action in parser._actions for option in action.option_strings]
        return f"unknown option {word}{did_you_mean(word, options) or '; miniRT --help lists all'}"
    if choice := CHOICE.fullmatch(message):
        choices = re.sub(r"'", "", choice["choices"])
        hint = did_you_mean(choice["value"], choices.split(", "))
        listed = " or ".join(choices.rsplit(", ", 1))
        return f"argument {choice['option']}: must be {listed}, got '{choice['value'][:40]}'{hint}"
    return message.removeprefix("unrecognized arguments: ")

"""Arguments of the command line, its exit statuses, and standard streams, which may be closed or full.

`options.txt` has the options, their choices and help texts; `other_programs.txt` has the words of other programs for
them. A parser of a value raises ArgumentTypeError, which says what is wrong with a text.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from argparse import ArgumentTypeError
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from io import TextIOWrapper
from math import nan
from typing import Any, NoReturn, TextIO

from minirt.errors import RenderError, did_you_mean, hint, nearest, printable
from minirt.helpers import package

OK = 0  # exit statuses
FAILED = 1  # an error in a scene, in rendering or in writing
USAGE = 2  # wrong arguments; 128 + n after a signal n, such as Ctrl+C
SAMPLES, WINDOW_SAMPLES = 1, 16  # default samples a pixel: of a file, of the window
OPENING = "opening"  # the example scene of a program without arguments
MAX_DEPTH = 32  # bounces of light
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


def whole_number(text: str, low: int, high: int, other: str = "") -> int:
    """Parse a whole number in [low, high]; `other` names what else is allowed."""
    if not (text.isascii() and text.isdigit() and len(text) < 10 and low <= int(text) <= high):
        raise ArgumentTypeError(f"must be a whole number from {low} to {high}{other}, got '{text[:40]}'")
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
            say(message, is_own=True)
        else:
            tell(message.rstrip("\n"))


# Groups, each with a title and then, for each option: its names, `=` and its value if it has one, two spaces, its help.
OPTIONS = package.read(__name__, "options.txt").decode()
# Defaults of options that are not off or unset without one.
DEFAULTS: dict[str, object] = {"keys": "auto", "text_scale": 1.0, "camera": 1}
KINDS: dict[str, Callable[[str], object]] = {  # parsers of values that are more than a text
    **dict.fromkeys(("output", "fallback", "replay", "report", "against", "compare"), file_name),
    **dict.fromkeys(("error", "time"), number),
    "size": partial(numbers, sign="x", form="WIDTHxHEIGHT, like 640x480", limits=[(1, MOST)] * 2),
    "region": partial(
        numbers, sign=",", form="X,Y,WIDTH,HEIGHT, like 320,0,640,480", limits=[(0, MAX_SIDE)] * 2 + [(1, MAX_SIDE)] * 2
    ),
    "explain": partial(numbers, sign=",", form="X,Y, like 320,240", limits=[(0, MAX_SIDE)] * 2),
    "samples": lambda text: text if text == "auto" else whole_number(text, 1, 65536, ", or auto"),
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
    description = "Show a .rt scene in a window, or render it to a file."
    parser = Arguments(prog="miniRT", description=description, allow_abbrev=False)
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
                has_choices = value.startswith("{")
                how |= {"choices": [*map(kind, value[1:-1].split(","))]} if has_choices else {"metavar": value}
            add(*names.split(), help=about, **how)
    return parser


def clearer(parser: argparse.ArgumentParser, message: str) -> str:
    """Return a message of argparse about wrong arguments as one plain line, with a suggestion where there is one."""
    if unknown := UNKNOWN.match(message):
        word = unknown[1].partition("=")[0]
        options = [option for action in parser._actions for option in action.option_strings]
        rows = package.read(__name__, "other_programs.txt").decode().splitlines()
        table = (row.partition("  ") for row in rows)  # an option, and what other programs call it
        meant = [ours for ours, _, others in table if word.lstrip("-") in others.split()]
        begun = [option for option in options if option.startswith(word)]  # options that the word abbreviates
        near = meant or nearest(word, begun or options, cutoff=0 if begun else 0.6)  # 0: any of them is near enough
        return f"unknown option {word}{hint(''.join(near)) or '; miniRT --help lists all'}"
    if choice := CHOICE.fullmatch(message):
        choices = re.sub(r"'", "", choice["choices"])
        similar = did_you_mean(choice["value"], choices.split(", "))
        listed = " or ".join(choices.rsplit(", ", 1))
        return f"argument {choice['option']}: must be {listed}, got '{choice['value'][:40]}'{similar}"
    message = message.replace("expected one argument", "must be followed by a value; miniRT --help tells which")
    return message.removeprefix("unrecognized arguments: ")


# What was asked for goes to standard output; RenderError when that fails. Notices go to standard error, or are dropped.


def prepare_streams() -> None:
    """Open the standard streams that the caller has closed, and let standard output write every character.

    Otherwise the next file to be opened would get the number of a closed stream, and with it what is printed. Writing
    to a stream that is opened here fails, so that the loss of what was asked for is an error.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with suppress(OSError):
                os.fstat(number)
                continue  # a file has this number: leave it alone
            mode = "r" if name == "stdin" else "w"
            unwritable = os.open(os.devnull, os.O_RDONLY)  # gets the lowest free number, which is `number`
            setattr(sys, name, open(unwritable, mode, encoding="utf-8", closefd=False))  # noqa: SIM115
    if isinstance(sys.stdout, TextIOWrapper) and sys.stdout.errors == "strict":
        sys.stdout.reconfigure(errors="backslashreplace")  # as standard error does


def say(text: object, is_own: bool = False) -> None:
    """Print lines to standard output without control characters. Bytes, and a text that `is_own`, made by the program
    with its colours and line ends, are written as they are. RenderError when that fails; BrokenPipeError when nobody
    reads any more."""
    try:
        if isinstance(text, bytes):
            sys.stdout.buffer.write(text)
        elif is_own:
            print(text, end="")
        else:
            print_lines(text, sys.stdout)
        sys.stdout.flush()
    except OSError as error:
        mute(sys.stdout)
        if isinstance(error, BrokenPipeError):  # the reader has closed the pipe, and needs no message
            raise
        raise RenderError(f"standard output: cannot write: {error.strerror or error}") from None


def tell(text: object, stream: TextIO | None = None) -> None:
    """Print lines to standard error, or to another stream, without control characters; do nothing when that fails."""
    stream = stream or sys.stderr
    try:
        print_lines(text, stream)
    except OSError:
        mute(stream)


def print_lines(text: object, stream: TextIO) -> None:
    """Print lines without control characters, which the name of a file may have, and which could act on a terminal."""
    print(*map(printable, str(text).split("\n")), sep="\n", file=stream, flush=True)


def mute(stream: TextIO) -> None:
    """Discard what a stream still holds and will get, which Python would try to write at its end."""
    with suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)

"""The command `python -m minirt.mlx`: its arguments, and running the program."""

from __future__ import annotations

import argparse
import runpy
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from minirt.errors import MlxError
from minirt.mlx.drop_in import script
from minirt.mlx.drop_in.headless import Headless
from minirt.mlx.drop_in.shim import install

if TYPE_CHECKING:
    from collections.abc import Sequence

FAILED = 1  # exit status


def main(argv: Sequence[str] | None = None) -> Any:
    """Run the program; return the argument of its `sys.exit`, or 0. Its exceptions come through."""
    options = _parse(argv)
    try:
        backend = _headless(options) if options.headless else None
        install(backend, strict=options.strict)
        try:
            status = _run(options.program, options.arguments)
        finally:  # even after an exception
            saved = backend is None or backend.finish()
    except MlxError as error:
        print(f"mlx: {error}", file=sys.stderr)
        return FAILED
    return status if saved else FAILED


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Parse the arguments; those after the program are its own."""
    parser = argparse.ArgumentParser(
        prog="python -m minirt.mlx",
        description="Run a program for the official Python wrapper of MiniLibX (from mlx import Mlx), unchanged.",
        epilog=f"Scripts of events:\n{(script.__doc__ or '').split(chr(10), 2)[2]}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--headless", action="store_true", help="open no window; time is simulated")
    parser.add_argument("--events", type=Path, metavar="SCRIPT", help="the events of a headless program")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="save the last picture of a headless program")
    parser.add_argument(
        "--screen", default="1920x1080", metavar="WxH", help="size of the simulated screen (%(default)s)"
    )
    parser.add_argument("--strict", action="store_true", help="end at the first failure or exception of a hook")
    parser.add_argument("program", type=Path)
    parser.add_argument("arguments", nargs=argparse.REMAINDER, help="arguments of the program")
    options = parser.parse_args(argv)
    if (options.events or options.picture) and not options.headless:
        parser.error("--events and --picture need --headless")
    return options


def _headless(options: argparse.Namespace) -> Headless:
    """Make the back end with its script. Raises MlxError."""
    try:
        width, height = map(int, options.screen.split("x"))
    except ValueError as error:
        raise MlxError(f"--screen: expected a size like 1920x1080, got {options.screen!r}") from error
    backend = Headless(options.picture, (width, height))
    if options.events:
        try:
            lines = options.events.read_text(encoding="utf-8").splitlines()
        except (OSError, ValueError) as error:
            raise MlxError(f"{options.events} cannot be read: {error}") from error
        script.add_script(lines, str(options.events), backend)
    backend.simulate_process()
    return backend


def _run(program: Path, arguments: list[str]) -> Any:
    """Run the program as `python program.py …` does; return what it exits with. Raises MlxError if there is none."""
    if not program.is_file():
        raise MlxError(f"there is no program {program}")
    sys.argv = [str(program), *arguments]
    sys.path[0] = str(program.resolve().parent)
    try:
        runpy.run_path(str(program), run_name="__main__")
    except SystemExit as leaving:
        return leaving.code
    return 0

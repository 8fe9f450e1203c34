"""Run a program that is written for the official Python wrapper of MiniLibX: `python -m minirt.mlx program.py`.

The program is unchanged: it says `from mlx import Mlx`. It runs in a window or, with simulated time, without a screen.
"""

from __future__ import annotations

import argparse
import os
import runpy
import sys
import threading
import time
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from minirt.errors import MlxError, ReplayError, printable
from minirt.helpers.file_io import is_file
from minirt.mlx import recording
from minirt.mlx.api import Mlx
from minirt.mlx.arguments import Host, Integer, MaybeNone, integer
from minirt.mlx.display import NO_WINDOW, Display
from minirt.mlx.headless import Headless
from minirt.mlx.window import Window

FAILED = 1  # exit status
READING = 1e-6  # seconds that pass with each reading of a clock, so that a loop that waits for a time ends


def main(argv: Sequence[str] | None = None) -> Any:
    """Run the program that `argv` names, `sys.argv` without it; return the argument of its `sys.exit`, or 0.

    FAILED after an MlxError or ReplayError, which is printed, or if the last picture cannot be saved. Other exceptions
    of the program are raised.
    """
    options = _parse(argv)
    try:
        backend = _headless(options) if options.headless else None
        install(backend, strict=options.strict)
        try:
            status = _run(options.program, options.arguments)
        finally:  # even after an exception
            saved = backend is None or backend.finish()
    except (MlxError, ReplayError) as error:
        print(f"mlx: {printable(str(error))}", file=sys.stderr)
        return FAILED
    return status if saved else FAILED


def _parse(argv: Sequence[str] | None) -> argparse.Namespace:
    """Parse the arguments; those after the program's name belong to the program."""
    _, _, commands = (recording.__doc__ or "\n\n").split("\n", 2)
    parser = argparse.ArgumentParser(
        prog="python -m minirt.mlx",
        description="Run a program for the official Python wrapper of MiniLibX (from mlx import Mlx), unchanged.",
        epilog=f"Scripts of events:\n{commands}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
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
    """Make the back end of `--headless`, with its script, and simulate time. Raises MlxError, ReplayError."""
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
        recording.add_recording(lines, str(options.events), backend, types=False)  # such programs read keys
    simulate_process(backend)
    return backend


def _run(program: Path, arguments: list[str]) -> Any:
    """Run the program as `python program.py …` does; return what it exits with. Raises MlxError if there is none."""
    if not is_file(program):
        raise MlxError(f"there is no program {program}")
    sys.argv = [str(program), *arguments]
    sys.path[0] = str(Path(os.path.realpath(program)).parent)
    try:
        runpy.run_path(str(program), run_name="__main__")
    except SystemExit as leaving:
        return leaving.code
    return 0


def install(backend: Display | None, *, strict: bool) -> None:
    """Make `from mlx import Mlx` import our class, even if the wrapper is installed.

    backend: the one that each Mlx uses, None for the screen. strict: see `minirt.mlx.arguments.Options`.
    """

    class WrapperMlx(Mlx):
        def __init__(self) -> None:
            super().__init__(backend, strict=strict)

        def mlx_string_put(
            self, mlx_ptr: Host, win_ptr: Window, x: Integer, y: Integer, color: Integer, string: str
        ) -> int:
            """Draw text in a colour 0xBBGGRR: in text, and only there, the wrapper's shader takes blue for red."""
            word = integer(color)
            red, green, blue = word & 0xFF, word & 0xFF00, word >> 16 & 0xFF
            swapped = red << 16 | green | blue
            return super().mlx_string_put(mlx_ptr, win_ptr, x, y, swapped, string)

        def _mlx_failed(self, error: MlxError) -> MaybeNone:
            advice = "; --headless runs without one" if str(error).startswith(NO_WINDOW) else ""
            return super()._mlx_failed(MlxError(f"{error}{advice}"))

    WrapperMlx.__name__ = WrapperMlx.__qualname__ = "Mlx"
    WrapperMlx.__module__ = "mlx.mlx"
    module: Any = ModuleType("mlx")  # both the package and its module
    module.__spec__, module.__path__ = ModuleSpec("mlx", None, is_package=True), []
    module.Mlx, module.mlx = WrapperMlx, module
    sys.modules["mlx"] = sys.modules["mlx.mlx"] = module


def simulate_process(user: Headless) -> None:
    """Let the program see the simulated time of `user`, and save its picture even if it ends by `os._exit`.

    Functions of `time` and `os` are replaced for the whole process. Sleeping in the main thread lets simulated time
    pass; other threads sleep as usual. Call this before the program, which may import these functions by their names.
    """
    start, sleep, leave = time.time(), time.sleep, os._exit

    def read() -> float:
        user.pass_time(READING)
        return user.time()

    def simulated_sleep(seconds: float) -> None:
        if threading.current_thread() is threading.main_thread():
            user.pass_time(seconds)
        else:
            sleep(seconds)

    def save_and_leave(status: int) -> None:
        leave(status if user.finish() else FAILED)

    time.monotonic = time.perf_counter = read
    time.time = lambda: start + read()
    time.monotonic_ns = time.perf_counter_ns = lambda: int(1e9 * read())
    time.time_ns = lambda: int(1e9 * (start + read()))
    time.sleep, os._exit = simulated_sleep, save_and_leave  # type: ignore[assignment]


if __name__ == "__main__":
    raise SystemExit(main())

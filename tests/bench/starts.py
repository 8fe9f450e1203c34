"""The table of starts: miniRT's, cold and warm, in files and in windows, beside peers that are programs."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path

from tests.bench.measure import Cells, available, take_turns
from tests.bench.peers.povray import PovRay
from tests.bench.peers.tachyon import Tachyon
from tests.bench.start import HEIGHT, WIDTH, FileStart, PeerStart
from tests.bench.system import MissingError, Setting, System
from tests.bench.table import table
from tests.bench.virtual_screen import virtual_screen
from tests.bench.window_start import WindowStart


def measured(setting: Setting, scenes: list[Path], rounds: int) -> tuple[Cells, list[str]]:
    """Measure starts of miniRT and of the peers that are programs; return why others are left out."""
    folder = setting.folder / "starts"
    folder.mkdir(exist_ok=True)
    small = Setting(WIDTH, HEIGHT, setting.threads, folder)
    with ExitStack() as stack:
        makers: list[Callable[[], System]] = [partial(FileStart, small, cold) for cold in (False, True)]
        try:
            screen = stack.enter_context(virtual_screen(WIDTH, HEIGHT))
            makers += [partial(WindowStart, small, cold, screen) for cold in (False, True)]
            reasons = []
        except MissingError as reason:
            reasons = [str(reason)]
        makers += [partial(PeerStart, peer, small) for peer in (Tachyon, PovRay)]
        systems, _ = available(makers)  # of peers that are missing, their frames tell
        return take_turns(systems, scenes, rounds, 0.0), reasons


def report(cells: Cells, rounds: int) -> str:
    """Return the table of starts with its heading."""
    systems, scenes = (list(dict.fromkeys(each)) for each in zip(*cells, strict=True))
    return (
        f"Whole programs, until their picture of {WIDTH}x{HEIGHT} pixels is in a file or in a window.\n"
        f"Median of {rounds} starts; a cold one finds an empty cache of kernels.\n\n"
        f"{table(cells, systems, scenes, 'ms to a picture')}"
    )

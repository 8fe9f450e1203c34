"""A screen in memory (Xvfb), whose pixels can be read at any moment without asking the X server."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.bench.system import INSTALL, MissingError
from tests.processes import started

Pixels = NDArray[np.uint8]  # (height, width, 3), red green blue


class Screen(NamedTuple):
    """A running screen: its name for DISPLAY, and a view of its memory that follows what is drawn."""

    name: str
    pixels: Pixels


@contextmanager
def virtual_screen(width: int, height: int) -> Iterator[Screen]:
    """Start a screen, which ends with the block; `MissingError` if Xvfb is not installed."""
    if not shutil.which("Xvfb"):
        raise MissingError(f"windows: Xvfb is not installed; {INSTALL}")
    with tempfile.TemporaryDirectory() as folder:
        reader, writer = os.pipe()
        command = ["Xvfb", "-displayfd", str(writer), "-screen", "0", f"{width}x{height}x24"]
        command += ["-fbdir", folder, "-nolisten", "tcp", "-noreset"]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with os.fdopen(reader) as number, started(command, pass_fds=(writer,), **quiet) as server:
            os.close(writer)
            name = number.readline().strip()  # comes when the server is ready; empty if it ended
            if not name:
                raise MissingError("windows: Xvfb does not start")
            try:
                yield Screen(f":{name}", pixels_of(Path(folder) / "Xvfb_screen0"))
            finally:
                server.terminate()  # rather than kill, so that it removes its files
                server.wait()


def pixels_of(dump: Path) -> Pixels:
    """Map a file in X Window Dump format: a header of big-endian words, a colour table, rows of 32-bit pixels."""
    header = np.fromfile(dump, ">u4", 25)
    header_size, width, height, row_size, colours = (int(header[i]) for i in (0, 4, 5, 12, 19))
    if header[11] != 32 or header[7] != 0:  # bits per pixel; byte order, 0 is least significant first
        raise ValueError("the pixels of the screen are not 32-bit BGRX")
    rows = np.memmap(dump, np.uint8, "r", offset=header_size + 12 * colours, shape=(height, row_size))
    return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]

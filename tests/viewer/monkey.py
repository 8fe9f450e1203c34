"""Monkey test of the viewer: random keys, mouse events, window sizes and file changes, without errors or memory leaks.

python -m tests.viewer.monkey 20        # minutes, in a real window under Xvfb
python -m tests.viewer.monkey 20 7      # with another seed
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import groupby, islice
from pathlib import Path
from typing import NamedTuple

from PIL import Image

from minirt.scene import load
from minirt.viewer.bindings import BINDINGS, MOUSE
from tests.usage import Record, Usage
from tests.viewer.fake import WITH_CYLINDER, write
from tests.viewer.idle_waits import until_at_rest, until_compiled, until_events_are_done
from tests.viewer.xdotool import do
from tests.waiting import HANG_LIMIT
from tests.windows import Desktop, open_desktop

SIZE = (320, 240)
EXCLUDED = {"quit", "toggle full screen"}
RARE = {"save", "save copy", "screenshot", "reload", "toggle help", "delete"}
FILE_VERSIONS = (
    WITH_CYLINDER,
    WITH_CYLINDER.replace("A 0.2", "A 0.6"),
    "A 0.2\n",
    "sp",
    "",
    WITH_CYLINDER + "sp 1,1,1 0.5 9,99,200 mirror:0.4\n",
    WITH_CYLINDER + "sp 1,1,1 0.5 9,99,200 texture:picture.png bump:picture.png\nob mesh.obj 0,1,0 1 9,9,9\n",
    WITH_CYLINDER.replace("-0.995 60", "-0.995 60 tone:filmic lens:0.1")
    + "bg picture.png\nob mesh.obj 0,1,0 1 9,9,9\n",
)
APART = ("resize", "wait")  # commands for which the program or the window manager needs time
BATCH = 15  # lines between two checks of the program
FILE_CHANGES = 0.15  # probability that another program writes the file after a batch


class Report(NamedTuple):
    """The result of a run, and what it used."""

    status: int
    output: str
    errors: str
    record: Record
    lines: int  # that were performed


def lines(chance: random.Random) -> Iterator[str]:
    """Yield random lines of a recording, without end."""
    keys = [
        key
        for binding in BINDINGS
        for key in binding.keys
        if binding.action not in EXCLUDED and not any(key.endswith(part) for part in MOUSE)
        for _ in range(1 if binding.action in RARE else 5)
    ]

    width, height = SIZE

    def place() -> str:
        return f"{chance.randrange(width)},{chance.randrange(height)}"  # within the window: outside are those of others

    yield f"move {place()}"  # the wheel acts on the window under the pointer
    while True:
        kind = chance.random()
        button = chance.choice(["", "", " right", " middle"])
        if kind < 0.58:
            yield f"press {chance.choice(keys)}"
        elif kind < 0.62:  # an element or an attribute from a list
            yield from (f"press {chance.choice('NM')}", *["press Down"] * chance.randint(0, 24), "press Return")
        elif kind < 0.64:
            yield from ("press F2", f"text {chance.choice(['head', 'x # y', 'l'])}", "press Return")
        elif kind < 0.67:  # several elements
            yield from ("down Shift", *(f"click {place()}" for _ in range(3)), "up Shift")
        elif kind < 0.72:
            yield f"click {place()}{' right' if button == ' right' else ''}"
        elif kind < 0.8:
            yield f"drag {place()} {place()}{button}"
        elif kind < 0.85:
            yield from ("down Shift", f"drag {place()} {place()}", "press d", "up Shift")
        elif kind < 0.94:
            yield f"wheel {chance.choice(['up', 'down'])} {chance.randint(1, 4)}"
        elif kind < 0.96:
            yield from ("press d", "hide", "wait 0.3", "show")
        else:
            width, height = chance.randint(1, 400), chance.randint(1, 300)
            yield from (f"resize {width}x{height}", "wait 0.3", f"move {place()}")


class Monkey:
    """Random input to one window."""

    def __init__(self, desktop: Desktop, process: subprocess.Popen[str], path: Path, seed: int) -> None:
        self.desktop = desktop
        self.process = process
        self.path = path
        self.chance = random.Random(seed)
        self.lines = lines(random.Random(seed))
        self.done = 0
        self.window = desktop.find(f"miniRT - {path.name}", SIZE)

    def batch(self) -> None:
        """Perform some lines, and now and then write the file as another program would."""
        batch = list(islice(self.lines, BATCH))
        try:
            self.do(*batch, "up Shift")
            until_events_are_done(self.process.pid)
        except (subprocess.CalledProcessError, OSError, AssertionError):
            assert self.process.poll() is None, f"{self.process.communicate()[1]}\nafter {batch}"
            raise
        self.done += len(batch)
        if self.chance.random() < FILE_CHANGES:
            write(self.path, self.chance.choice(FILE_VERSIONS))
        for written in self.path.parent.glob("scene-*"):
            written.unlink()

    def do(self, *batch: str) -> None:
        """Perform lines; wait after a resize for the window manager, and where a line says so."""
        for word, group in groupby(batch, lambda line: next(filter(line.startswith, APART), "")):
            if word == "resize":
                for line in group:
                    self.desktop.resize(self.window, *map(int, line.split()[1].split("x")))
            elif word == "wait":
                until_events_are_done(self.process.pid)
            else:
                do(self.desktop, self.window, *group)

    def idle_usage(self) -> Usage:
        """Return what the program uses with the first scene at the first size."""
        self.desktop.restore(self.window)
        write(self.path, WITH_CYLINDER)
        self.do("press Ctrl+R", "resize {}x{}".format(*SIZE), "move 0,0")
        until_compiled(self.process.pid)
        until_at_rest(self.process.pid)
        return Usage.of(self.process.pid)


def run_monkey(
    desktop: Desktop,
    share: Callable[[int], float],
    seed: int,
    folder: Path,
    parts: int = 2,
    show: Callable[[str], object] = lambda _: None,
) -> Report:
    """Send random input to a window; AssertionError if the program ends before its end is requested.

    `share(lines)`: the share of the run that is over after so many lines. What the program uses is measured, and shown,
    after each of so many `parts` of the run.
    """
    path = folder / "scene.rt"
    path.write_text(WITH_CYLINDER)
    Image.new("RGB", (8, 8), (200, 120, 40)).save(folder / "picture.png")
    (folder / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    command = [sys.executable, "-W", "error", "-m", "minirt", str(path), "--size", f"{SIZE[0]}x{SIZE[1]}"]
    with desktop.program("env", f"XDG_STATE_HOME={folder}", *command) as process:
        monkey = Monkey(desktop, process, path, seed)
        record = Record(parts, monkey.idle_usage, show)
        while (progress := share(monkey.done)) < 1:
            monkey.batch()
            record.note(progress)
        record.note(1.0)
        desktop.key(monkey.window, "Escape")
        output, errors = process.communicate(timeout=HANG_LIMIT)
        load(path)  # the saved file is a valid scene
        return Report(process.returncode, output, errors, record, monkey.done)


if __name__ == "__main__":
    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with open_desktop() as opened, tempfile.TemporaryDirectory() as folder:
        show = partial(print, flush=True)
        start = time.monotonic()
        report = run_monkey(
            opened,
            lambda _: (time.monotonic() - start) / (60 * minutes),
            seed,
            Path(folder),
            max(6, round(minutes)),
            show,
        )
    print(f"{report.lines} lines, {report.record.verdict}", report.output, report.errors, sep="\n")
    sys.exit(report.status != 0 or bool(report.errors) or not report.record.is_flat)

"""A monkey at the viewer: keys and mouse at random, and nothing may break.

python -m tests.viewer.monkey 20        # minutes, in a real window under Xvfb
python -m tests.viewer.monkey 20 7      # with another seed
"""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from minirt.scene import load
from minirt.viewer.bindings import BINDINGS
from minirt.viewer.chords import MOUSE
from tests.viewer.hands import do
from tests.windows import Desktop, open_desktop

TEXT = """\
A 0.2 255,255,255
C 0,1,8 0,-0.1,-0.995 60
L 5,5,5 0.6 255,255,255
sp 0,0,0 2 255,60,60
pl 0,-1,0 0,1,0 90,200,90
cy 2,0,0 0,1,0 1 2 60,60,255
"""
SIZE = (320, 240)
KEPT_AWAY = {"quit", "toggle full screen", "save copy", "screenshot"}  # it would fill the disk, or lose its window
SELDOM = {"save", "reload", "toggle help", "delete"}
BATCH = 15  # lines between two looks at the program
SETTLED = 0.3  # of the time: what the program needs to have seen everything once


class Report(NamedTuple):
    """How it went."""

    status: int
    output: str
    errors: str
    before: int  # bytes of memory when everything was seen once
    after: int  # bytes of memory at the end
    lines: int  # that were done


def lines(chance: random.Random) -> Iterator[str]:
    """What a monkey does, without end."""
    keys = [
        key
        for binding in BINDINGS
        for key in binding.keys
        if binding.action not in KEPT_AWAY and not any(key.endswith(part) for part in MOUSE)
        for _ in range(1 if binding.action in SELDOM else 5)
    ]

    width, height = SIZE

    def place() -> str:
        return f"{chance.randrange(width)},{chance.randrange(height)}"  # beside it is what belongs to others

    while True:
        kind = chance.random()
        button = chance.choice(["", "", " right", " middle"])
        if kind < 0.6:
            yield f"press {chance.choice(keys)}"
        elif kind < 0.7:
            yield f"click {place()}{' right' if button == ' right' else ''}"
        elif kind < 0.8:
            yield f"drag {place()} {place()}{button}"
        elif kind < 0.85:
            yield from ("down Shift", f"drag {place()} {place()}", "press d", "up Shift")
        elif kind < 0.95:
            yield f"wheel {chance.choice(['up', 'down'])} {chance.randint(1, 4)}"
        else:
            width, height = chance.randint(1, 400), chance.randint(1, 300)
            yield from (f"resize {width}x{height}", "wait 0.3")


def memory(process: subprocess.Popen[str]) -> int:
    """Bytes that the program holds."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return 1024 * int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")))


def play(desktop: Desktop, seconds: float, seed: int, folder: Path) -> Report:
    """Let the monkey play in a window of its own; AssertionError where the program ends before it is told to."""
    path = folder / "scene.rt"
    path.write_text(TEXT)
    command = [sys.executable, "-W", "error", "-m", "minirt", str(path), "--size", f"{SIZE[0]}x{SIZE[1]}"]
    with desktop.program(*command) as process:
        window = desktop.find(f"miniRT - {path.name}")
        chance = random.Random(seed)
        acts, done, before = lines(chance), 0, 0
        start = time.monotonic()
        while (spent := time.monotonic() - start) < seconds:
            batch = [next(acts) for _ in range(BATCH)]
            batch += ["up Shift"]
            do(desktop, window, *batch)
            done += len(batch)
            assert process.poll() is None, f"{process.communicate()[1]}\nafter {batch}"
            if spent > SETTLED * seconds and not before:
                before = memory(process)
        after = memory(process)
        desktop.key(window, "Escape")
        output, errors = process.communicate(timeout=30)
        load(path)  # whatever was saved is a scene
        return Report(process.returncode, output, errors, before, after, done)


if __name__ == "__main__":
    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with open_desktop() as opened, tempfile.TemporaryDirectory() as room:
        found = play(opened, 60 * minutes, seed, Path(room))
    print(found)
    sys.exit(found.status != 0 or bool(found.errors))

"""A monkey at the viewer: keys and mouse at random, and nothing may break.

python -m tests.viewer.monkey 20        # minutes, in a real window under Xvfb
python -m tests.viewer.monkey 20 7      # with another seed
"""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from PIL import Image

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
KEPT_AWAY = {"quit"}
SELDOM = {"save", "save copy", "screenshot", "reload", "toggle help", "toggle full screen", "delete"}
FULL_SCREEN = [f"press {key}" for each in BINDINGS if each.action == "toggle full screen" for key in each.keys]
OTHERS = (TEXT, TEXT.replace("A 0.2", "A 0.6"), "A 0.2\n", "sp", "", TEXT + "sp 1,1,1 0.5 9,99,200 mirror:0.4\n")
BATCH = 15  # lines between two looks at the program
FILE_CHANGES = 0.15  # how often another program writes the file then
SETTLED = 0.5  # of the time: what the program needs to have seen everything once
FLAT = 1.05  # times the memory of then: what it may have at the end


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
        elif kind < 0.94:
            yield f"wheel {chance.choice(['up', 'down'])} {chance.randint(1, 4)}"
        elif kind < 0.96:
            yield from ("press d", "hide", "wait 0.3", "show")
        else:
            width, height = chance.randint(1, 400), chance.randint(1, 300)
            yield from (f"resize {width}x{height}", "wait 0.3")


def memory(process: subprocess.Popen[str]) -> int:
    """Bytes that the program holds."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return 1024 * int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")))


def used(process: subprocess.Popen[str]) -> float:
    """Seconds of processor time that it has had."""
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Play:
    """A monkey's time with a window of its own."""

    FIRST_SIZE = f"resize {SIZE[0]}x{SIZE[1]}", "wait 2"

    def __init__(self, desktop: Desktop, process: subprocess.Popen[str], path: Path, seed: int) -> None:
        self.desktop = desktop
        self.process = process
        self.path = path
        self.chance = random.Random(seed)
        self.lines = lines(self.chance)
        self.done = 0
        self.find()

    def find(self) -> None:
        """Another window may be the program's since the screen was filled or left."""
        self.window = self.desktop.find(f"miniRT - {self.path.name}")

    def batch(self) -> None:
        """Some lines, and now and then another program that writes the file."""
        batch: list[str] = []
        while len(batch) < BATCH and not (batch and batch[-1] in FULL_SCREEN):
            batch.append(next(self.lines))
        try:
            do(self.desktop, self.window, *batch, "up Shift")
        except subprocess.CalledProcessError:  # the window went while the monkey was at it
            self.find()
        self.wait()
        self.done += len(batch)
        if batch[-1] in FULL_SCREEN:
            do(self.desktop, self.window, "wait 0.5")
            self.find()
        assert self.process.poll() is None, f"{self.process.communicate()[1]}\nafter {batch}"
        if self.chance.random() < FILE_CHANGES:
            self.write(self.chance.choice(OTHERS))
        for written in self.path.parent.glob("scene-*"):
            written.unlink()

    def wait(self) -> None:
        """Let the program come to rest, as a person would who looks at it: what it is behind with is in a queue."""
        for _ in range(20):
            before = used(self.process)
            do(self.desktop, self.window, "wait 0.1")
            if used(self.process) - before < 0.05:
                return

    def write(self, text: str) -> None:
        """Be another program."""
        new = self.path.with_name("new")
        new.write_text(text)
        new.replace(self.path)

    def settled(self) -> int:
        """Bytes of memory with the scene of the file in a window of the first size."""
        self.write(TEXT)
        do(self.desktop, self.window, "press Ctrl+R", "wait 1", *self.FIRST_SIZE)
        if self.desktop.size(self.window) != SIZE:  # which a window as large as the screen cannot have
            do(self.desktop, self.window, FULL_SCREEN[0], "wait 1")
            self.find()
            do(self.desktop, self.window, *self.FIRST_SIZE)
        assert self.desktop.size(self.window) == SIZE
        return memory(self.process)


def play(desktop: Desktop, seconds: float, seed: int, folder: Path) -> Report:
    """Let the monkey play in a window; AssertionError where the program ends before it is told to."""
    path = folder / "scene.rt"
    path.write_text(TEXT)
    Image.new("RGB", (8, 8), (200, 120, 40)).save(folder / "picture.png")
    command = [sys.executable, "-W", "error", "-m", "minirt", str(path), "--size", f"{SIZE[0]}x{SIZE[1]}"]
    with desktop.program(*command) as process:
        monkey = Play(desktop, process, path, seed)
        start = time.monotonic()
        before = 0
        while (spent := time.monotonic() - start) < seconds:
            monkey.batch()
            if spent > SETTLED * seconds and not before:
                before = monkey.settled()
        after = monkey.settled()
        monkey.find()
        desktop.key(monkey.window, "Escape")
        output, errors = process.communicate(timeout=30)
        load(path)  # whatever was saved is a scene
        return Report(process.returncode, output, errors, before, after, monkey.done)


if __name__ == "__main__":
    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with open_desktop() as opened, tempfile.TemporaryDirectory() as room:
        found = play(opened, 60 * minutes, seed, Path(room))
    print(found)
    sys.exit(found.status != 0 or bool(found.errors) or found.after > FLAT * found.before)

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
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from PIL import Image

from minirt.scene import load
from minirt.viewer.input.bindings import BINDINGS
from minirt.viewer.input.chords import MOUSE
from tests.viewer.idle_waits import until_at_rest, until_events_are_done
from tests.viewer.process_tree import compilers
from tests.viewer.scenes import WITH_CYLINDER
from tests.viewer.xdotool import do
from tests.waiting import HANG_LIMIT, until
from tests.windows import SCREEN, Desktop, open_desktop

SIZE = (320, 240)
KEPT_AWAY = {"quit"}
SELDOM = {"save", "save copy", "screenshot", "reload", "toggle help", "toggle full screen", "delete"}
FULL_SCREEN = [f"press {key}" for each in BINDINGS if each.action == "toggle full screen" for key in each.keys]
OTHERS = (
    WITH_CYLINDER,
    WITH_CYLINDER.replace("A 0.2", "A 0.6"),
    "A 0.2\n",
    "sp",
    "",
    WITH_CYLINDER + "sp 1,1,1 0.5 9,99,200 mirror:0.4\n",
)
BATCH = 15  # lines between two looks at the program
FILE_CHANGES = 0.15  # how often another program writes the file then
SETTLED = 0.5  # of the play: what the program needs to have seen everything once
FLAT = 1.05  # times the memory of then: what it may have at the end


class Report(NamedTuple):
    """How it went."""

    status: int
    output: str
    errors: str
    before: int  # bytes of memory when everything was seen once
    after: int  # bytes of memory at the end
    lines: int  # that were done
    full_screens: int  # how often the window began or ceased to fill the screen


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

    yield f"move {place()}"  # the wheel turns where the pointer is
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
            yield from (f"resize {width}x{height}", "wait 0.3", f"move {place()}")


def memory(process: subprocess.Popen[str]) -> int:
    """Bytes that the program holds."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    return 1024 * int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS")))


class Play:
    """A monkey's time with a window of its own."""

    def __init__(self, desktop: Desktop, process: subprocess.Popen[str], path: Path, seed: int) -> None:
        self.desktop = desktop
        self.process = process
        self.path = path
        self.chance = random.Random(seed)
        self.lines = lines(self.chance)
        self.done = 0
        self.size = SIZE  # of the window, while it does not fill the screen
        self.wanted = SIZE
        self.fills_screen = False
        self.full_screens = 0
        self.find()

    def find(self) -> None:
        """Another window may be the program's since the screen was filled or left."""
        self.window = self.desktop.find(f"miniRT - {self.path.name}", SCREEN if self.fills_screen else self.size)

    def batch(self) -> None:
        """Some lines, and now and then another program that writes the file."""
        batch: list[str] = []
        while len(batch) < BATCH and not (batch and batch[-1] in FULL_SCREEN):
            batch.append(next(self.lines))
        try:
            self.do(*batch, "up Shift")
            if batch[-1] in FULL_SCREEN:
                self.await_full_screen()
            until_events_are_done(self.process.pid)
        except (subprocess.CalledProcessError, OSError, AssertionError):
            assert self.process.poll() is None, f"{self.process.communicate()[1]}\nafter {batch}"
            raise
        self.done += len(batch)
        if self.chance.random() < FILE_CHANGES:
            self.write(self.chance.choice(OTHERS))
        for written in self.path.parent.glob("scene-*"):
            written.unlink()

    def do(self, *batch: str) -> None:
        """Do lines; wait where the window manager has something to do, or where they say so."""
        ready: list[str] = []
        for line in batch:
            word, _, size = line.partition(" ")
            if word not in ("resize", "wait"):
                ready.append(line)
                continue
            do(self.desktop, self.window, *ready)
            ready.clear()
            if word == "resize":
                width, height = size.split("x")
                self.resize((int(width), int(height)))
            else:
                until_events_are_done(self.process.pid)
        do(self.desktop, self.window, *ready)

    def resize(self, size: tuple[int, int]) -> None:
        """Resize the window; one that fills the screen is asked to in vain, and again when it has left the screen."""
        self.wanted = size
        if self.fills_screen:
            do(self.desktop, self.window, f"resize {size[0]}x{size[1]}")
        else:
            self.desktop.resize(self.window, *size)
            self.size = size

    def await_full_screen(self) -> None:
        """Wait until the window fills the screen, or does no more, after the key for that."""
        self.fills_screen = not self.fills_screen
        self.full_screens += 1
        self.find()
        self.resize(self.wanted)
        self.do("move 0,0")

    def write(self, text: str) -> None:
        """Be another program."""
        new = self.path.with_name("new")
        new.write_text(text)
        new.replace(self.path)

    def settled(self) -> int:
        """Bytes of memory with the scene of the file in a window of the first size; then it has the last one again."""
        wanted = self.wanted
        self.desktop.restore(self.window)
        if self.fills_screen:
            self.do(FULL_SCREEN[0])
            self.await_full_screen()
        self.write(WITH_CYLINDER)
        self.do("press Ctrl+R", "resize {}x{}".format(*SIZE))
        until(lambda: not compilers(self.process.pid), "the end of the compiler")
        until_at_rest(self.process.pid)
        held = memory(self.process)
        self.do("resize {}x{}".format(*wanted), "move 0,0")
        return held


def play(desktop: Desktop, share: Callable[[int], float], seed: int, folder: Path) -> Report:
    """Let the monkey play in a window; AssertionError where the program ends before it is told to.

    `share`: of the whole play, how much is over after so many lines.
    """
    path = folder / "scene.rt"
    path.write_text(WITH_CYLINDER)
    Image.new("RGB", (8, 8), (200, 120, 40)).save(folder / "picture.png")
    command = [sys.executable, "-W", "error", "-m", "minirt", str(path), "--size", f"{SIZE[0]}x{SIZE[1]}"]
    with desktop.program(*command) as process:
        monkey = Play(desktop, process, path, seed)
        before = 0
        while (over := share(monkey.done)) < 1:
            monkey.batch()
            if over > SETTLED and not before:
                before = monkey.settled()
        after = monkey.settled()
        desktop.key(monkey.window, "Escape")
        output, errors = process.communicate(timeout=HANG_LIMIT)
        load(path)  # whatever was saved is a scene
        return Report(process.returncode, output, errors, before, after, monkey.done, monkey.full_screens)


def share_of_time(seconds: float) -> Callable[[int], float]:
    """The share of so many seconds that is over, whatever the number of lines."""
    start = time.monotonic()
    return lambda _: (time.monotonic() - start) / seconds


if __name__ == "__main__":
    minutes, seed = float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1
    with open_desktop() as opened, tempfile.TemporaryDirectory() as room:
        found = play(opened, share_of_time(60 * minutes), seed, Path(room))
    print(found)
    sys.exit(found.status != 0 or bool(found.errors) or found.after > FLAT * found.before)

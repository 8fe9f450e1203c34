"""Kill a program at random moments while it edits, and read back what it kept on disk.

python -m tests.viewer.kill COUNT [SEED]     # prints what was lost, in seconds; status 1 if more than one
"""

from __future__ import annotations

import itertools
import os
import random
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from minirt.scene import load, parse
from minirt.viewer.files import signature
from minirt.viewer.recovery import Recovery, Version, find_changes
from tests import processes
from tests.viewer.fake import TEXT

PAUSE = 0.002  # seconds between two edits
LOSS = 1.0  # seconds of edits that may be lost
LONGEST = 1.5  # seconds until a program is killed, after its first edit


class Trial(NamedTuple):
    """Edits of a killed program, and those that are on disk."""

    kept: list[float]  # seconds of each edit, as a process beside it saw them
    flushed: int  # the last version that was certainly on disk
    recovered: int  # version; 0: the file as it was
    killed: float  # seconds

    @property
    def lost(self) -> float:
        """Seconds from the first lost edit to the kill; 0 if none is lost."""
        return self.killed - self.kept[self.recovered] if self.recovered < len(self.kept) else 0.0


@contextmanager
def state_folder(folder: Path) -> Iterator[None]:
    """Let unsaved changes be kept in a folder, for the block and programs that are started in it."""
    before = os.environ.get("XDG_STATE_HOME")
    os.environ["XDG_STATE_HOME"] = str(folder)
    try:
        yield
    finally:
        os.environ.pop("XDG_STATE_HOME")
        if before is not None:
            os.environ["XDG_STATE_HOME"] = before


def trial(folder: Path, wait: float, edits: int = 0) -> Trial:
    """Start the program in an empty folder, kill it some seconds after its first edit, and read what it kept.

    `edits`: as in `edit_forever`.
    """
    path = folder / "scene.rt"
    path.write_text(TEXT)
    kept: list[float] = []
    flushed = 0
    command = [sys.executable, "-m", "tests.viewer.kill", "edit", str(path), str(edits)]
    with state_folder(folder / "state"), processes.started(command, stdout=-1, text=True) as process:
        assert process.stdout is not None
        timer = threading.Timer(wait, process.kill)
        for line in process.stdout:
            word, number = line.split()
            if word == "flushed":
                flushed = int(number)
            else:
                kept.append(time.monotonic())
                if len(kept) == 1:
                    timer.start()
        killed = time.monotonic()
        timer.join()
        process.wait()
        found = find_changes(path)
    recovered = round(parse(found.text, path.name).scene.spheres[0].diameter) if found else 0
    return Trial(kept, flushed, recovered, killed)


def edit_forever(path: Path, edits: int) -> None:
    """Edit a scene for ever: version N has a sphere of diameter N. Write a line `kept N` after each edit.

    After each `edits` edits flush what is kept, and write `flushed N`; with 0 leave that to the timer.
    """
    saved = scene = load(path).scene
    known, recovery, pause = signature(path), Recovery(), threading.Event()
    for number in itertools.count(1):
        scene = scene.replace(scene.spheres[0], diameter=float(number))
        recovery.keep(Version(scene, saved, path, known))
        os.write(1, b"kept %d\n" % number)
        if edits and number % edits == 0:
            recovery.flush()
            os.write(1, b"flushed %d\n" % number)
        pause.wait(PAUSE)


def main(count: int, seed: int = 1) -> int:
    """Run the trials and print the losses."""
    chance = random.Random(seed)
    trials = []
    for _ in range(count):
        with tempfile.TemporaryDirectory() as folder:
            trials.append(trial(Path(folder), LONGEST * chance.random()))
    losses = sorted(each.lost for each in trials)
    broken = sum(each.recovered < each.flushed for each in trials)
    none = sum(each.recovered == 0 for each in trials)
    edits = sum(len(each.kept) for each in trials)
    print(f"{count} kills after {edits} edits: lost at most {losses[-1]:.3f} s, median {losses[count // 2]:.3f} s")
    print(f"{none} with nothing kept yet; {broken} without a version that was flushed")
    return int(losses[-1] > LOSS or broken > 0)


if __name__ == "__main__":
    if sys.argv[1] == "edit":
        edit_forever(Path(sys.argv[2]), int(sys.argv[3]))
    sys.exit(main(*map(int, sys.argv[1:])))

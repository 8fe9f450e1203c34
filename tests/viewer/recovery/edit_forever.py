"""A program that edits a scene without end and keeps each version in its journal, until it is killed.

python -m tests.viewer.recovery.edit_forever SCENE EDITS

It writes a line `kept N` after each edit. After each EDITS edits it flushes the journal and writes `flushed N`; with 0
it leaves that to the thread of the journal.
"""

from __future__ import annotations

import itertools
import os
import sys
import threading
from pathlib import Path

from minirt.scene import load
from minirt.viewer.files import signature
from minirt.viewer.recovery.journal import Journal, Version

PAUSE = 0.002  # seconds between two edits


def main(file: str, edits: int) -> None:
    """Edit for ever: version N has a sphere of diameter N."""
    path = Path(file)
    saved = scene = load(path).scene
    known = signature(path)
    journal = Journal()
    pause = threading.Event()
    for number in itertools.count(1):
        scene = scene.replace(scene.spheres[0], diameter=float(number))
        journal.keep(Version(scene, saved, path, known))
        os.write(1, b"kept %d\n" % number)
        if edits and number % edits == 0:
            journal.flush()
            os.write(1, b"flushed %d\n" % number)
        pause.wait(PAUSE)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))

"""Fuzzer of recordings: each is refused with a place, or played in a window in memory, without an error.

Recordings that nothing damaged are played; those that take long in simulated time are read alone.
"""

from __future__ import annotations

import random
import re
import tempfile
from pathlib import Path

from minirt.errors import ReplayError
from minirt.mlx.memory import Memory
from minirt.viewer.app.replay import play
from minirt.viewer.bindings import BINDINGS, KEYS, MOUSE
from minirt.viewer.input.recording import add_recording
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.mutations import mutated
from tests.viewer.fake import TEXT, FakeRenderer, scene
from tests.viewer.monkey import lines

NAME = "keys.txt"
LAYOUTS = ("qwerty", "azerty", "qwertz")
CHORDS = [key for binding in BINDINGS for key in binding.keys if not any(key.endswith(part) for part in MOUSE)]
LONG = re.compile(rb"[0-9]{2,}|[eE][+]?[0-9]")  # seconds, or pixels
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")


def make(chance: random.Random) -> bytes:
    """Make a recording, mutated or not."""
    monkey = lines(chance)
    made = [next(monkey) for _ in range(chance.randint(1, 12))]
    for _ in range(chance.randint(0, 6)):
        made.insert(chance.randint(0, len(made)), line(chance))
    data = "\n".join(made).encode()
    return mutated(data, chance) if chance.random() < 0.6 else data


def line(chance: random.Random) -> str:
    """Return a line that the monkey has not."""
    key, held = chance.choice(CHORDS), chance.choice(("a", "d", "Left", "Shift+Up", "PageUp", "R"))
    return chance.choice(
        (
            f"press {key}", f"press {key}",
            f"hold {held} 0.{chance.randint(0, 9)}", f"press {chance.choice(list(KEYS))}",
            f"text {chance.choice(('0.5', '+-', '1,2,3', 'é', 'a=b'))}", "wait 0.5", "hide", "show", "close", "# note",
            "drop scene.rt", "drop nothing.png",
            "press Return", "press Escape", "resize 1x1", "move 9999,0",
        )
    )  # fmt: skip


def check(data: bytes) -> str:
    """Read the recording, and play it if that is quick."""
    recorded = data.decode("utf-8", "replace").splitlines()
    refusal = refused(recorded)
    if refusal:
        assert refusal.startswith(f"{NAME}:")
        return "refused"
    timed = [each.split() for each in data.split(b"\n") if each.split()[:1] in ([b"wait"], [b"hold"])]
    seconds = [word for words in timed for word in words]
    if any(map(LONG.search, seconds)) or data.count(b"\n") > 100:
        return "read"
    path = Path(FOLDER.name) / "scene.rt"
    path.write_text(TEXT)
    play(
        scene(), recorded, renderer=FakeRenderer(), size=(64, 48), path=path, file=NAME,
        keys=LAYOUTS[len(data) % len(LAYOUTS)],
    )  # fmt: skip
    forget_files()
    return "played"


def refused(recorded: list[str]) -> str:
    """Return the error of a recording; nothing where it is read."""
    try:
        add_recording(recorded, NAME, Memory())
    except ReplayError as error:
        return str(error)
    return ""


def forget_files() -> None:
    """Delete what a session has written beside its scene: screenshots and copies."""
    for each in Path(FOLDER.name).iterdir():
        each.unlink()


FUZZER = Fuzzer(make, check, 15)

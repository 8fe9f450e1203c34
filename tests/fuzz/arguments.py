"""Fuzzer of the command line and of its file of defaults: every run ends with a status and, where it failed, one error.

Runs check a scene, or write a small picture; no window opens.
"""

from __future__ import annotations

import io
import os
import random
import tempfile
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path

from minirt.cli import main
from minirt.helpers.system import limit_memory
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.mutations import mutated

SCENE = "A 1 9,99,255\nC 0,0,0 0,0,1 60\n"  # nothing to draw, so that no kernel is needed
VALUES = (
    "", "-", "0", "1", "2", "16", "auto", "8x6", "0x0", "16384x1", "16385x1", "nan", "inf", "-1", "1e-3", "1-2", "2-1",
    "srgb", "plain", "single", "double", "azerty", "scene.rt", "missing.rt", "broken.rt", ".", "/dev/null", "a.png",
    "a.nothing", "{name}.png", "a\udcff.png", "é", "9" * 400, "bash", "demo", "nothing", "300M", "4GiB",
)  # fmt: skip
WITH_VALUE = (
    "--size", "--samples", "--turntable", "--frames", "--bits", "--quality", "--error", "--time", "--tone",
    "--exposure",
    "--fallback", "--keys", "--text-scale",
    "--precision", "--depth", "--config", "--completion", "--example", "-o",
    "--threads", "--memory",
)  # fmt: skip
ALONE = (
    "--metadata", "--no-metadata", "--strict", "--dither", "--left-handed", "--watch", "--no-watch", "--lenient",
    "--json", "--quick", "--list-keys", "-v", "--version", "--help", "--nothing", "--", "-x", "--siz", "--s",
)  # fmt: skip
DEFAULTS = (
    'samples = 4\nsize = "8x6"\n',
    "dither = true\n",
    "quality = 101\n",
    "threads = [1]\n",
    "x",
    "\0",
    "a.b = 1\n",
)
OK, FAILED, USAGE = 0, 1, 2
SEPARATOR = b"\0"
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")


def make(chance: random.Random) -> bytes:
    """Make arguments, separated by zeros; the first is the text of a file of defaults."""
    words = [chance.choice(("scene.rt", "scene.rt", "scene.rt", chance.choice(VALUES)))]
    for _ in range(chance.choice((0, 1, 1, 2, 3, 5))):
        name, value = chance.choice(WITH_VALUE), chance.choice(VALUES)
        words += chance.choice(([name, value], [f"{name}={value}"], [name], [chance.choice(ALONE)], [value]))
    encoded = [word.encode("utf-8", "surrogateescape") for word in words]
    if chance.random() < 0.4:
        at = chance.randrange(len(encoded))
        encoded[at] = mutated(encoded[at], chance).replace(SEPARATOR, b"")
    defaults = chance.choice(DEFAULTS).encode().replace(SEPARATOR, b"\x01")
    return SEPARATOR.join([defaults if chance.random() < 0.2 else b"", *encoded])


def check(data: bytes) -> str:
    """Run the program with the arguments, and `--check`, which renders nothing."""
    defaults, *words = data.split(SEPARATOR)
    folder = Path(FOLDER.name)
    (folder / "scene.rt").write_text(SCENE)
    (folder / "broken.rt").write_text("A 2\n")
    (folder / "defaults.toml").write_bytes(defaults)
    arguments = [os.fsdecode(word) for word in words]
    configuration = ["--config=defaults.toml"] if defaults else ["--config="]
    try:
        status, out, err = run(["--check", *configuration, *arguments], folder)
    finally:
        limit_memory(None)
    assert status in (OK, FAILED, USAGE), f"status {status}"
    assert "Traceback" not in out + err
    assert not status or err.startswith("Error\n") or "\nError\n" in err, f"status {status} with {err!r}"
    assert status or "Error\n" not in err, f"an error with status 0: {err!r}"
    return ("accepted", "failed", "refused")[status]


def run(arguments: list[str], folder: Path) -> tuple[int, str, str]:
    """Run the program in a folder; return its status, standard output and standard error."""
    streams = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="surrogateescape") for _ in range(2)]
    with chdir(folder), redirect_stdout(streams[0]), redirect_stderr(streams[1]):
        try:
            status: object = main(arguments)
        except SystemExit as error:
            status = error.code
    texts = []
    for stream in streams:
        stream.flush()
        stream.seek(0)
        texts.append(stream.read())
    return (status if isinstance(status, int) else OK if status is None else -1), *texts  # type: ignore[return-value]


FUZZER = Fuzzer(make, check, 60)

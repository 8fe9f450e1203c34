"""Fuzzers of the command line, of meshes, pictures and recordings: how an input is made, and how it is checked."""

from __future__ import annotations

import io
import os
import random
import re
import tempfile
import warnings
from contextlib import chdir, redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from PIL import Image

from minirt.cli import main
from minirt.errors import FileError, ReplayError
from minirt.helpers.system import limit_memory
from minirt.lanes.decimals import LARGEST
from minirt.materials import pictures
from minirt.materials.pictures import SIDE
from minirt.meshes import obj, obj_bytes, obj_lines
from minirt.meshes.obj_lines import ObjError
from minirt.meshes.triangles import Triangles
from minirt.mlx.events import KEYS
from minirt.mlx.memory import Memory
from minirt.mlx.recording import add_recording
from minirt.viewer.app.replay import play
from minirt.viewer.bindings import BINDINGS, MOUSE
from tests.fuzz.mutations import Fuzzer, flip, mutated
from tests.viewer.fake import TEXT, FakeRenderer, scene
from tests.viewer.monkey import lines

EMPTY = "A 1 9,99,255\nC 0,0,0 0,0,1 60\n"  # nothing to draw, so that no kernel is needed
VALUES = (
    "", "-", "0", "1", "2", "16", "auto", "8x6", "0x0", "16384x1", "16385x1", "nan", "inf", "-1", "1e-3", "1-2", "2-1",
    "srgb", "plain", "single", "double", "azerty", "scene.rt", "missing.rt", "broken.rt", ".", "/dev/null", "a.png",
    "a.nothing", "{name}.png", "a\udcff.png", "é", "9" * 400, "bash", "demo", "nothing", "300M", "4GiB",
)  # fmt: skip
WITH_VALUE = (
    "--size", "--samples", "--turntable", "--frames", "--bits", "--quality", "--error", "--time", "--tone",
    "--exposure", "--fallback", "--keys", "--text-scale", "--precision", "--depth", "--config", "--completion",
    "--example", "-o", "--threads", "--memory",
)  # fmt: skip
ALONE = (
    "--metadata", "--no-metadata", "--strict", "--dither", "--left-handed", "--watch", "--no-watch", "--lenient",
    "--json", "--quick", "--list-keys", "-v", "--version", "--help", "--nothing", "--", "-x", "--siz", "--s",
)  # fmt: skip
DEFAULTS = ('samples = 4\nsize = "8x6"', "dither = true", "quality = 101", "threads = [1]", "x", "\0", "a.b = 1")
OK = 0
VERDICTS: dict[object, str] = {OK: "accepted", 1: "failed", 2: "refused"}  # by exit status
SEPARATOR = b"\0"
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")
WORK = Path(FOLDER.name)  # for the files of an input


def make_arguments(chance: random.Random) -> bytes:
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


def check_arguments(data: bytes) -> str:
    """Run the program with the arguments, and `--check`, which renders nothing."""
    defaults, *words = data.split(SEPARATOR)
    (WORK / "scene.rt").write_text(EMPTY)
    (WORK / "broken.rt").write_text("A 2\n")
    (WORK / "defaults.toml").write_bytes(defaults)
    configuration = "--config=defaults.toml" if defaults else "--config="
    try:
        status, out, err = run_program(["--check", configuration, *map(os.fsdecode, words)])
    finally:
        limit_memory(None)
    assert status in VERDICTS, f"status {status}"
    assert "Traceback" not in out + err
    assert bool(status) == bool(re.search(r"^Error$", err, re.MULTILINE)), f"status {status} with {err!r}"
    return VERDICTS[status]


def run_program(arguments: list[str], folder: Path = WORK) -> tuple[object, str, str]:
    """Run the program in a folder; return its status, standard output and standard error."""
    out, err = io.StringIO(), io.StringIO()
    with chdir(folder), redirect_stdout(out), redirect_stderr(err):
        try:
            status: object = main(arguments)
        except SystemExit as error:
            status = error.code or OK
    return status, out.getvalue(), err.getvalue()


ARGUMENTS = Fuzzer(make_arguments, check_arguments, 60)


# Meshes: the fast and the diagnosing reader agree, and the size of blocks changes nothing.

NUMBERS = (
    *(f"{0.37 * k:.{k % 10}f}" for k in range(-40, 40)),
    "0",
    "-1",
    "1e15",
    "-1e15",
    "5e-324",
    "1e-400",
    ".5",
    "1.",
    "+2",
)
OTHERS = ("", "# é", "g a", "s off", "usemtl x", "o # y", "l 1 2", "\t", "v 1 2 \\", "#v")
SMALL_BLOCK = 60  # bytes


def make_mesh(chance: random.Random) -> bytes:
    """Make a mesh, mutated or not; most are written as programs write them."""
    counts = chance.randint(3, 9), chance.choice((0, 0, 2, 5)), chance.choice((0, 0, 1, 4))
    rows = []
    for key, count, width in zip(("v", "vt", "vn"), counts, (3, 2, 3), strict=True):
        rows += [" ".join((key, *(chance.choice(NUMBERS) for _ in range(width)))) for _ in range(count)]
    faces = [face(counts, chance) for _ in range(chance.randint(1, 6))]
    rows += faces if chance.random() < 0.8 else [*faces, *rows]
    if chance.random() < 0.3:
        rows.insert(chance.randint(0, len(rows)), chance.choice(OTHERS))
    if chance.random() < 0.1:
        chance.shuffle(rows)
    data = chance.choice(("\n", "\n", "\r\n")).join([*rows, ""]).encode()
    return mutated(data, chance) if chance.random() < 0.6 else data


def face(counts: tuple[int, ...], chance: random.Random) -> str:
    """Return a face of some corners, each with a point, a place on a picture and a normal."""
    corners = (
        "/".join(str(chance.randint(1, count) * chance.choice((1, 1, -1))) if count else "" for count in counts)
        for _ in range(chance.choice((3, 3, 3, 4, 5)))
    )
    return " ".join(("f", *(corner.rstrip("/") for corner in corners)))


FLOAT, INDEX = rb"[ \t\r\v\f]+[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", rb"[-+]?0*[1-9][0-9]*"
LINE = re.compile(
    rb"\s*((v(%b){3,7}|vt(%b){1,3}|vn(%b){3}|f([ \t\r\v\f]+%b(/(%b)?(/(%b)?)?)?){3,})|%b\S+([ \t\r\v\f].*)?)?\s*"
    % (FLOAT, FLOAT, FLOAT, INDEX, rb"[-+]?[0-9]+", rb"[-+]?[0-9]+", rb"(?!(v|vt|vn|f)(\s|\Z))")
)


def grammar_tables(data: bytes) -> list[list[list[float]]] | None:
    """Read a mesh line by line by a strict grammar: points, uvs, normals and corners; None where it is wrong."""
    items: dict[bytes, list[Any]] = {b"v": [], b"vt": [], b"vn": [], b"f": []}
    for line in re.sub(rb"\\\r*(\n|\Z)", b" ", data).split(b"\n"):
        text = line.partition(b"#")[0]
        key, *words = text.split() or [b""]
        parts = [word.split(b"/") for word in words if key in items]
        if not LINE.fullmatch(text) or any(len(each) > 300 for word in parts for each in word):
            return None
        if key == b"f":
            counts = [len(items[each]) for each in (b"v", b"vt", b"vn")]
            for word in parts:
                named = [int(each or 0) for each in (word + 2 * [b""])[:3]]
                corner = [n - 1 if n >= 0 else count + n for n, count in zip(named, counts, strict=True)]
                if max(map(abs, named)) >= LARGEST or corner[0] < 0:
                    return None
                nowhere = obj_bytes.NOWHERE
                items[key].append([nowhere if n < 0 > at else at for n, at in zip(named, corner, strict=True)])
        elif key in items:
            if not all(abs(float(word)) <= 1e15 for word in words):
                return None
            items[key].append([*map(float, words), 0.0][: 2 if key == b"vt" else 3])
    return list(items.values())


def check_mesh(data: bytes) -> str:
    """Compare the reader with the grammar; a mesh that is accepted is finite and names corners that exist."""
    expected = grammar_tables(data)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found: Any = obj_lines.read(data)
        except ObjError:
            found = None
        assert (found is None) == (expected is None), "reader or grammar alone accepts it"
        assert not expected or all(each.tolist() == rows for each, rows in zip(found, expected, strict=False))
        whole, blocks = (mesh_of(data, size) for size in (obj.BLOCK_BYTES, SMALL_BLOCK))
    assert (whole is None) == (blocks is None), "the size of blocks decides whether a mesh is accepted"
    if whole is None or blocks is None:
        return "refused"
    for name in ("points", "corners", "normals", "uvs"):
        assert np.array_equal(getattr(whole, name), getattr(blocks, name)), f"the size of blocks changes {name}"
    assert np.isfinite(whole.points).all()
    assert 0 <= whole.corners.min() <= whole.corners.max() < len(whole.points)
    return "accepted"


def mesh_of(data: bytes, block: int) -> Triangles | None:
    """Return the triangles of a mesh that is read in blocks of so many bytes; None where it is refused."""
    with patch.object(obj, "BLOCK_BYTES", block):
        try:
            return obj.parse(data)
        except ObjError:
            return None


MESHES = Fuzzer(make_mesh, check_mesh, 300)


# Pictures on surfaces and as skies: damaged files of each format give pixels, or an error about the file.

PILLOW = {  # format -> modes, or modes with options
    "PNG": ("RGB", "RGBA", "L", "P", "1", "I;16", "LA"),
    "JPEG": ("RGB", "L", "CMYK"),
    "BMP": ("RGB",), "GIF": ("P",), "PPM": ("RGB",), "TGA": ("RGB", "RGB tga_rle"), "WEBP": ("RGB", "RGBA"),
    "TIFF": [f"RGB {name}" for name in ("raw", "tiff_lzw", "tiff_adobe_deflate", "packbits", "jpeg")],
}  # fmt: skip
XPM = b'/* XPM */\nstatic char *a[] = {\n"2 2 2 1",\n"a c #FF8800",\n"b c #0000FF",\n"ab",\n"ba"\n};\n'
RADIANCE = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 8\n" + 2 * (b"\2\2\0\10" + 4 * b"\x88\x80")
SIZE = (9, 7)
READERS = (pictures.picture, pictures.heights, pictures.sky)


@cache
def originals() -> list[bytes]:
    """Return a small file of each format."""
    noise = Image.frombytes("RGB", SIZE, random.Random(1).randbytes(3 * SIZE[0] * SIZE[1]))
    files = [XPM, RADIANCE]
    for name, (mode, *option) in ((name, words.split()) for name, each in PILLOW.items() for words in each):
        file = io.BytesIO()
        made = noise.convert("L") if mode == "I;16" else noise
        made.convert(mode).save(file, name, **({"compression": option[0]} if option else {}))
        files.append(file.getvalue())
    return files


def make_picture(chance: random.Random) -> bytes:
    """Make a picture; nine of ten are damaged, most of them by a few bits, so that decoders get far."""
    data = chance.choice(originals())
    kind = chance.random()
    if kind < 0.1:
        return data
    for _ in range(chance.randint(1, 4)):
        data = flip(data, chance)
    return data if kind < 0.6 else data[: chance.randint(0, len(data))] if kind < 0.7 else mutated(data, chance)


def check_picture(data: bytes) -> str:
    """Read the picture in all ways; an original is accepted in at least one."""
    path = WORK / "picture"
    path.write_bytes(data)
    accepted = 0
    for read in READERS:
        try:
            pixels = read(path)
        except FileError as error:
            message = str(error)
            assert str(path) in message
            assert "\n" not in message, f"an error of several lines: {message}"
            continue
        accepted += 1
        assert pixels.ndim == (2 if read is pictures.heights else 3)
        assert 0 < pixels.size <= 3 * SIDE**2
        assert np.isfinite(pixels).all()
    assert accepted or data not in originals(), "a good picture is refused"
    return "accepted" if accepted else "refused"


PICTURES = Fuzzer(make_picture, check_picture, 150)


# Recordings: each is refused with a place, or played in a window in memory, or only read where that would take long.

NAME = "keys.txt"
LONG = re.compile(rb"[0-9]{2,}|[eE][+]?[0-9]")  # seconds, or pixels
CHORDS = [key for binding in BINDINGS for key in binding.keys if not any(key.endswith(part) for part in MOUSE)]
OTHER_LINES = (  # which the monkey has not
    *(f"press {key}" for key in (*CHORDS, *KEYS, "Return", "Escape")),
    *(f"hold {key} 0.{tenths}" for key in ("a", "d", "Left", "Shift+Up", "PageUp", "R") for tenths in (0, 4, 9)),
    *(f"text {words}" for words in ("0.5", "+-", "1,2,3", "é", "a=b")),
    "wait 0.5", "hide", "show", "close", "# note", "drop scene.rt", "drop nothing.png", "resize 1x1", "move 9999,0",
)  # fmt: skip


def make_replay(chance: random.Random) -> bytes:
    """Make a recording, mutated or not."""
    monkey = lines(chance)
    made = [next(monkey) for _ in range(chance.randint(1, 12))]
    for _ in range(chance.randint(0, 6)):
        made.insert(chance.randint(0, len(made)), chance.choice(OTHER_LINES))
    data = "\n".join(made).encode()
    return mutated(data, chance) if chance.random() < 0.6 else data


def check_replay(data: bytes) -> str:
    """Read the recording, and play it in a window in memory if that is quick."""
    recorded = data.decode("utf-8", "replace").splitlines()
    try:
        add_recording(recorded, NAME, Memory())
    except ReplayError as error:
        message = str(error)
        assert message.startswith(f"{NAME}:")
        return "refused"
    timed = re.findall(rb"^\s*(?:wait|hold)\s.*$", data, re.MULTILINE)
    if any(map(LONG.search, timed)) or len(recorded) > 100:
        return "read"
    path = WORK / "scene.rt"
    path.write_text(TEXT)
    play(scene(), recorded, renderer=FakeRenderer(), size=(64, 48), path=path, file=NAME)
    for each in WORK.iterdir():  # also screenshots and copies, which a session writes beside its scene
        each.unlink()
    return "played"


REPLAYS = Fuzzer(make_replay, check_replay, 15)

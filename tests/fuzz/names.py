"""Names of files that are long, forbidden, odd or missing, wherever a scene, a mesh or its materials name one.

The system refuses to look at files whose names hold `odd-` and the number of an error, as it does on a failing disk or
in a folder of others.
"""

from __future__ import annotations

import errno
import json
import os
import random
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from unittest.mock import patch

from minirt.errors import SceneError
from minirt.scene import load
from tests.fuzz.mutations import ODD, Fuzzer
from tests.fuzz.scenes import check_places

FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")
CODES = (errno.EACCES, errno.EIO, errno.ELOOP, errno.ENAMETOOLONG, errno.ESTALE, errno.EOVERFLOW, errno.ENOTDIR)
GOOD = ("a.png", "./a.png", "one.obj", "one.mtl", "../a.png", "deep/../a.png")
BAD = (
    "",
    " ",
    ".",
    "..",
    "/",
    "~",
    "none.png",
    "a.png/x",
    "deep",
    "loop",
    "fifo",
    "/dev/zero",
    "/dev/fd/0",
    "/proc/self/mem",
)
SCENE = ("texture:{}", "bump:{},0.5", "normal:{}", "texture:{} bump:{}", "checker texture:{} uv:2,2")
LINES = (
    *(f"sp 0,0,9 1 9,9,9 {each}" for each in SCENE),
    "bg {}",
    "ob {} 0,0,0 1 9,9,9",
    "ob a.obj 0,0,0 1 9,9,9 texture:{}",
)
FRAME = "A 1 9,9,9\nC 0,0,0 0,0,1 60\nsp 0,0,5 2 1,2,3\n"
FACE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def make_name(chance: random.Random) -> str:
    """Make a name, one of four long, odd, forbidden or one that is there."""
    odd = [each for each in ODD if isinstance(each, str)]
    name = chance.choice(
        (
            chance.choice(GOOD),
            chance.choice(BAD),
            chance.choice("ab/é ") * chance.choice((1, 254, 255, 256, 300, 4095, 5000)),
            f"odd-{chance.choice(CODES)}" + chance.choice(("", ".png", ".obj", "/x.png")),
            "".join(chance.choices(odd, k=chance.randint(1, 4))),
        )
    )
    return name if chance.random() < 0.8 else chance.choice(GOOD) + name


def make_names(chance: random.Random) -> bytes:
    """Make the names of one input, and the lines of the scene that name them: JSON."""
    names = {place: make_name(chance) for place in ("scene", "other", "library", "picture", "uri")}
    quotes = chance.choice(("{}", '"{}"'))
    lines = [line.replace("{}", quotes) for line in chance.sample(LINES, chance.randint(1, 3))]
    return json.dumps([names, lines]).encode()


@contextmanager
def failing_system() -> Iterator[None]:
    """Let the system refuse to look at some files, and to open them."""

    def refusing(function: Any) -> Any:
        def call(path: Any, *more: Any, **named: Any) -> Any:
            text = os.fsdecode(path) if isinstance(path, (str, bytes, os.PathLike)) else ""
            code = text.partition("odd-")[2].partition(".")[0].partition("/")[0]
            if code.isascii() and code.isdigit():
                raise OSError(int(code), os.strerror(int(code)), text)
            return function(path, *more, **named)

        return call

    with patch.multiple(os, **{name: refusing(getattr(os, name)) for name in ("stat", "lstat", "open", "scandir")}):
        yield


def check_names(data: bytes) -> str:
    """Check that each file that cannot be used is an error at a place of the scene, or is left out with a notice."""
    names, lines = json.loads(data)
    folder = folder_of(names)
    text = FRAME + "\n".join(line.replace("{}", names[place]) for line in lines for place in ("scene", "other"))
    path = folder / "fuzz.rt"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    verdicts = []
    with failing_system():
        for lenient in (False, True):
            try:
                reading = load(path, lenient)
                verdicts.append("with notices" if reading.notices else "accepted")
            except SceneError as error:
                check_places(error, path.read_bytes())
                verdicts.append("refused")
    return " and ".join(verdicts)


def folder_of(names: dict[str, str]) -> Path:
    """Return the folder of the scene, with meshes and materials that name files, too."""
    folder = Path(FOLDER.name) / "scenes"
    if not folder.exists():
        (folder / "deep").mkdir(parents=True)
        (folder / "loop").symlink_to("loop")
        os.mkfifo(folder / "fifo")
        for picture in (folder / "a.png", folder.parent / "a.png"):
            picture.write_bytes(b"P3 2 1 255 1 2 3 4 5 6\n")
        (folder / "one.obj").write_text(f"{FACE}f 1 2 3\n")
    texts = {
        "a.obj": f"mtllib {names['library']}\nmtllib a.mtl\n{FACE}usemtl red\nf 1 2 3\n",
        "a.mtl": f"newmtl red\nmap_Kd {names['picture']}\nmap_Bump -bm 2 {names['uri']}\n",
    }
    for name, text in texts.items():
        (folder / name).write_bytes(text.encode("utf-8", "surrogatepass"))
    return folder


NAMES = Fuzzer(make_names, check_names, 150)

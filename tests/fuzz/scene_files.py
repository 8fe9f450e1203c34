"""The files that random scenes name: two pictures and a mesh, in a folder of their own."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

from PIL import Image

PICTURES, MESHES = ("a.png", "maps/b+1.png"), ("ball.obj",)
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")


@cache
def folder() -> Path:
    """Return the folder, with its files."""
    made = Path(FOLDER.name)
    for name in PICTURES:
        (made / name).parent.mkdir(exist_ok=True)
        Image.new("RGB", (4, 2), (200, 120, 40)).save(made / name)
    for name in MESHES:
        (made / name).write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n")
    return made


def exists(name: str, suffix: str) -> bool:
    """Whether a scene in the folder can name a file so, with this suffix."""
    try:
        path = folder() / name
        return bool(name) and path.is_file() and path.suffix == suffix
    except (OSError, ValueError):
        return False

"""A full file system: pictures and films are refused with a reason; unsaved changes are kept if they fit."""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path

import pytest
from PIL import Image

from tests.cli.program import PROGRAM, SCENE, environment
from tests.full_disk import needs_mount, run_on_full_disk
from tests.processes import run

pytestmark = needs_mount

SMALL = ("--size", "160x120", "--no-metadata")
FULL = "No space left on device"
STREAMING = """
import minirt
try:
    minirt.render_to("x.tif", minirt.load("ball.rt"), 160, 640)
except minirt.RenderError as error:
    print(error)
"""
KEEPING = """
import sys
from pathlib import Path
from minirt.errors import SceneError
from minirt.scene import load
from minirt.viewer.files import signature
from minirt.viewer.recovery import Recovery, Version
path, book = Path("ball.rt"), Recovery()
saved = load(path).scene
for diameter in (3.0, 4.0):
    book.keep(Version(saved.replace(saved.spheres[0], diameter=diameter), saved, path, signature(path)))
    book.flush()
try:
    saved.replace(saved.spheres[0], diameter=5.0).save("ball.rt")
except SceneError as error:
    print(error)
"""


@pytest.mark.parametrize(
    ("target", "pages", "film"),
    [
        ("x.png", 0, ()),
        ("x.apng", 1, ("--turntable", "9")),
    ],
)
def test_a_picture_or_film_that_does_not_fit_leaves_the_old_one(
    tmp_path: Path, target: str, pages: int, film: tuple[str, ...]
) -> None:
    files = {"ball.rt": SCENE.encode(), target: b"old"}
    command = [*PROGRAM, "ball.rt", "-o", target, *SMALL, *film]
    status, out, err, left = run_on_full_disk(tmp_path, files, command, pages)
    assert (status, out, err) == (1, "", f"Error\n{target}: cannot write: {FULL}\n")
    assert left == files


def test_numbered_pictures_end_with_the_first_that_does_not_fit(tmp_path: Path) -> None:
    files = {"ball.rt": SCENE.encode(), "x-0002.png": b"old"}
    command = [*PROGRAM, "ball.rt", "-o", "x.png", *SMALL, "--turntable", "3"]
    status, out, err, left = run_on_full_disk(tmp_path, files, command, 1)
    assert (status, out, err) == (1, "", f"Error\nx-0002.png: cannot write: {FULL}\n")
    with Image.open(BytesIO(left.pop("x-0001.png"))) as picture:
        picture.load()
        assert picture.size == (160, 120)
    assert left == files


def test_a_streamed_picture_goes_on_when_there_is_room(tmp_path: Path) -> None:
    """The bands that are there are wanted; the journal goes when the picture is whole."""
    files = {"ball.rt": SCENE.encode(), "x.tif": b"old"}
    command = [sys.executable, "-c", STREAMING]
    status, out, err, left = run_on_full_disk(tmp_path, files, command, 1)
    assert (status, out, err) == (0, f"x.tif: cannot write: {FULL}\n", "")
    assert left.keys() == files.keys() | {".x.tif.journal"}
    assert left["x.tif"] == b"old"
    (tmp_path / "left" / "x.tif").unlink()
    ended = run([sys.executable, "-c", STREAMING], cwd=tmp_path / "left", env=environment(), text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")
    assert {path.name for path in (tmp_path / "left").iterdir()} == files.keys()
    with Image.open(tmp_path / "left" / "x.tif") as picture:
        picture.load()


@pytest.mark.parametrize("pages", [0, 1])
def test_where_nothing_can_be_saved_unsaved_changes_are_kept_if_they_fit(tmp_path: Path, pages: int) -> None:
    files = {"ball.rt": SCENE.encode()}
    command = [sys.executable, "-c", KEEPING]
    status, out, err, left = run_on_full_disk(tmp_path, files, command, pages, XDG_STATE_HOME=str(tmp_path / "disk"))
    assert (status, out) == (0, f"ball.rt: cannot be written: {FULL.lower()}\n")
    assert err == f"notice: unsaved changes cannot be kept on disk: [Errno 28] {FULL}\n"
    assert left.pop("ball.rt") == files["ball.rt"]
    kept = [data.decode() for name, data in left.items() if name.endswith(".rt")]
    assert kept == [SCENE.replace("sp 0,0,0 2", "sp 0,0,0 3")] * pages  # the next version has no room beside it

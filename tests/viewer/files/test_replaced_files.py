"""Another program may put anything in the place of the scene file: nothing waits for it, or reads all of it."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.scene import dump, files, load
from minirt.viewer.files import back_up, signature
from minirt.viewer.recovery.found_changes import find_changes
from minirt.viewer.recovery.journal import Version, text_of
from tests.guards import must_end, must_not_open
from tests.scene.examples import WHOLE


def put_pipe(path: Path) -> None:
    """Put a FIFO in the place of a file."""
    os.mkfifo(path)


def put_too_much(path: Path) -> None:
    """Put a file of more bytes than a scene may have in the place of a file."""
    with path.open("wb") as file:
        file.truncate(files.MAX_BYTES + 1)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no FIFOs")
@pytest.mark.parametrize("put", [put_pipe, put_too_much])
def test_what_takes_the_place_of_the_scene_is_not_read(tmp_path: Path, put: Callable[[Path], None]) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(WHOLE)
    scene = load(path).scene
    path.unlink()
    put(path)
    with must_end(), must_not_open(path):
        assert find_changes(path) is None
        assert text_of(Version(scene, scene, path, signature(path))) == dump(scene).encode()
        with pytest.raises(SceneError, match=r"is not a regular file|larger than 64 MiB"):
            back_up(path)
    assert list(tmp_path.iterdir()) == [path]


def test_the_scene_itself_is_read(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    path.write_text(WHOLE)
    scene = load(path).scene
    assert text_of(Version(scene, scene, path, signature(path))) == WHOLE.encode()
    assert back_up(path).read_text() == WHOLE

"""Saving replaces a scene file as a whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from minirt.errors import SceneError
from minirt.helpers import file_io
from minirt.scene import load, parse
from tests.scene.examples import WHOLE

SCENE = parse(WHOLE).scene


def refusal(path: Path | str) -> str:
    """Save to a path that is refused; return the message."""
    with pytest.raises(SceneError) as caught:
        SCENE.save(path)
    return str(caught.value)


def names(folder: Path) -> list[str]:
    """Return the sorted file names of a folder."""
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("text", [WHOLE, WHOLE.replace("\n", "\r\n"), "\ufeff" + WHOLE + "# é球"])
def test_loading_and_saving_changes_no_byte(tmp_path: Path, text: str) -> None:
    first, second = tmp_path / "first.rt", tmp_path / "second.rt"
    first.write_bytes(text.encode())
    load(first).scene.save(second)
    assert second.read_bytes() == text.encode()


def test_moving_one_object_changes_one_line(tmp_path: Path) -> None:
    path = tmp_path / "scene.rt"
    SCENE.replace(SCENE.cylinders[0], centre=(1.0, 2.0, 3.0)).save(path)
    lines = path.read_text().split("\n")
    assert [(old, new) for old, new in zip(WHOLE.split("\n"), lines, strict=True) if old != new] == [
        ("cy 0,0,20 0,1,0 2 5 255,200,0", "cy 1,2,3 0,1,0 2 5 255,200,0")
    ]


def test_a_new_file_has_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    (tmp_path / "other").touch()
    SCENE.save(tmp_path / "scene.rt")
    assert (tmp_path / "scene.rt").stat().st_mode == (tmp_path / "other").stat().st_mode


@pytest.mark.parametrize("mode", [0o600, 0o644, 0o755, 0o666])
def test_an_existing_file_keeps_its_permissions(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "scene.rt"
    path.write_text("old")
    path.chmod(mode)
    SCENE.save(path)
    assert path.read_text() == WHOLE
    assert path.stat().st_mode & 0o7777 == mode


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    target, link = tmp_path / "folder" / "target.rt", tmp_path / "link.rt"
    link.symlink_to("folder/target.rt")
    for old in (None, "old"):
        if old:
            target.write_text(old)
        SCENE.save(link)
        assert link.is_symlink()
        assert target.read_text() == WHOLE
    assert names(tmp_path) == ["folder", "link.rt"]


@pytest.mark.parametrize("step", ["fsync", "replace", "chmod"])
def test_a_failure_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    path = tmp_path / "scene.rt"
    path.write_text("old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os if step == "fsync" else Path, step, fail)
    assert refusal(path) == f"{path}: cannot be written: no space left on device"
    assert path.read_text() == "old"
    assert names(tmp_path) == ["scene.rt"]


def test_an_interrupt_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        SCENE.save(tmp_path / "scene.rt")
    assert names(tmp_path) == []


def test_paths_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.rt").mkdir()
    os.mkfifo(tmp_path / "fifo.rt")
    assert "not a regular file" in refusal(tmp_path / "folder.rt")
    assert "not a regular file" in refusal(tmp_path / "fifo.rt")
    assert "cannot be written: no such file or directory" in refusal(tmp_path / "missing" / "scene.rt")
    assert "cannot be written: not a directory" in refusal(tmp_path / "fifo.rt" / "scene.rt")
    assert "the name of a scene file ends in '.rt'" in refusal(tmp_path / "scene.txt")
    assert "no file can have this name" in refusal("a\0b.rt")
    assert names(tmp_path) == ["fifo.rt", "folder.rt"]


def test_a_write_protected_file_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.rt"
    path.write_text("old")
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write everywhere
    assert "cannot be written: permission denied" in refusal(path)
    assert path.read_text() == "old"


def test_bytes_are_written_unchanged(tmp_path: Path) -> None:
    file_io.write(tmp_path / "data", b"\r\n\0\xff")
    assert (tmp_path / "data").read_bytes() == b"\r\n\0\xff"

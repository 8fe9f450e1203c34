"""Saving replaces a scene file as a whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from minirt.errors import SceneError
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


@pytest.mark.parametrize("mode", [0o600, 0o666])
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
    assert "it is a folder" in refusal(tmp_path / "folder.rt")
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

"""A scene file for the tests of the viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from minirt.errors import MiniRTError
from minirt.viewer.app.session import Session
from tests.viewer.fake import TEXT


@pytest.fixture(autouse=True)
def defects(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Exception]]:
    """Errors that miniRT does not expect, which a window shows and outlives: a test that causes some takes them out."""
    found: list[Exception] = []

    def note(session: Session, error: Exception) -> None:
        if not isinstance(error, MiniRTError):
            found.append(error)
        show(session, error)

    show = Session.show_error
    monkeypatch.setattr(Session, "show_error", note)
    yield found
    for each in found:
        raise each


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return the path of a file with the usual scene."""
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file

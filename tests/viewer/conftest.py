"""A scene file for the tests of the viewer."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.viewer.fake import TEXT


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """Return the path of a file with the usual scene."""
    file = tmp_path / "scene.rt"
    file.write_text(TEXT)
    return file

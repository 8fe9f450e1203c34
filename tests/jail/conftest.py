"""Tests of the helper process: it decodes all files, and the list of known files is empty."""

from __future__ import annotations

from pathlib import Path

import pytest

from minirt.jail.decoding import state


@pytest.fixture(autouse=True)
def distrust(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Trust no file, and keep the list of known files in a folder of the test."""
    monkeypatch.setattr(state, "trusts_all", False)
    monkeypatch.setattr(state, "trusts_known", True)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

"""The measurement of latency reports each tap and each movement; how long they take is not tested."""

from __future__ import annotations

import pytest

from tests.bench import latency
from tests.viewer.fake import scene


def test_taps_and_movements_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"TAPS": 2, "TAP_DELAYS": (0.0, 0.01), "PAUSE": 0.01, "HOLD": 0.2}.items():
        monkeypatch.setattr(latency, name, value)
    measured = latency.measure(scene(), 64, 48)
    assert len(measured.taps) == len(measured.shown) == len(measured.divisors) == 2
    assert all(0 < handed < shown for handed, shown in zip(measured.taps, measured.shown, strict=True))
    assert sum(measured.held) >= 0.2
    assert sum(measured.dragged) >= 0.2
    assert min(measured.held + measured.dragged) > 0
    assert "taps" in str(measured)

"""The table of latencies, from invented figures."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.bench import latencies
from tests.bench.latencies import COMPARED, measured, records, table


def test_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each kind of latency has its median and its worst."""
    invented = SimpleNamespace(taps=[0.02, 0.01, 0.3], held=[0.016], dragged=[0.033, 0.017], shown=[9.0])
    monkeypatch.setattr(latencies, "load", lambda path: path)
    monkeypatch.setattr(latencies, "measure", lambda scene, width, height: invented)
    rows = list(measured([Path("a/rings.rt"), Path("a/sea.rt")], 64, 48))
    assert table(rows).splitlines() == [
        "ms, median and worst             rings          sea",
        "from a key to its picture  20.0    300  20.0    300",
        "while a key is held        16.0   16.0  16.0   16.0",
        "while the pointer drags    25.0   33.0  25.0   33.0",
    ]
    assert records(rows)[0] == {"scene": "rings", "kind": "taps", "median": 20.0, "worst": 300.0}


def test_the_scenes_exist() -> None:
    assert all(path.exists() for path in COMPARED)

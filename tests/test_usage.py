"""Records of long runs: which growth they notice, and a short soak run of the renderer."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tests.fuzz import soak
from tests.usage import Record, Usage

SHARES = [part / 60 for part in range(61)]


def record_of(usages: Iterator[Usage] | list[Usage], parts: int = 60) -> Record:
    """Return the record of a run that measures these."""
    record = Record(parts, iter(usages).__next__)
    for share in SHARES:
        record.note(share)
    return record


@pytest.mark.parametrize(
    ("growth", "expected"),
    [
        (lambda part: (0, 0, 0), True),
        (lambda part: (100e6 * min(part / 9, 1), 0, 0), True),  # before the warm-up has ended
        (lambda part: (20e6 * (part % 5 == 1), part % 2, part % 3), True),  # comes and goes
        (lambda part: (-1e6 * part, -part // 60, 0), True),
        (lambda part: (2e6 * part, 0, 0), False),
        (lambda part: (0, part // 30, 0), False),
        (lambda part: (0, 0, part // 30), False),
    ],
)
def test_growth_after_the_warm_up_is_noticed(growth, expected: bool) -> None:
    usages = [Usage(*(int(a + b) for a, b in zip((300e6, 12, 14), growth(part), strict=True))) for part in range(60)]
    record = record_of(usages)
    assert record.is_flat is expected
    assert record.verdict.startswith("flat") is expected
    assert list(record.usages) == list(range(1, 61))
    assert len(record.settled) == 51


def test_a_leak_of_each_picture_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    leaked: list[np.ndarray] = []
    monkeypatch.setattr(soak, "render", lambda *_: leaked.append(np.ones(2**18)))
    start = Usage.of().memory

    def measure() -> Usage:
        usage = Usage.of()
        return usage._replace(memory=usage.memory - start + 10**8)  # as if other tests had left nothing in memory

    record = Record(6, measure)
    soak.soak(lambda pictures: pictures / 24, 1, record)
    assert not record.is_flat

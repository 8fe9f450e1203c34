"""The measurement of latency reports each tap and each movement; how long they take is not tested."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tests.bench import latency
from tests.bench.latency import User
from tests.viewer.fake import scene


def test_an_error_of_the_user_is_that_of_the_measurement(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: User) -> None:
        raise ZeroDivisionError("the user fails")

    monkeypatch.setattr(User, "measure", fail)
    with pytest.raises(ZeroDivisionError, match="the user fails"):
        latency.measure(scene(), 64, 48)


def test_a_refined_picture_of_an_earlier_scene_does_not_answer_a_tap() -> None:
    session: Any = SimpleNamespace(
        draw=lambda: None,
        mlx=SimpleNamespace(mlx_put_image_to_window=None),
        screen=SimpleNamespace(mlx=SimpleNamespace()),
        refinement=SimpleNamespace(latest=None),
    )
    user = User(session, None)  # type: ignore[arg-type]

    def draw(shown: str, divisor: int) -> bool:
        job = SimpleNamespace(scene=shown, divisor=divisor)
        session.refinement.latest = SimpleNamespace(pixels=b"", job=job)
        user.draw_and_note()
        return user.finished.is_set()

    assert draw("first", 1)
    user.expect_picture()
    assert not draw("first", 1)  # drawn again, for a message
    assert not draw("second", 4)
    assert draw("second", 1)
    assert [shown.scene for shown in user.pictures] == ["first", "second"]


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

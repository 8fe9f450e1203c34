"""Signals that ask the program to end: where they end it, where they wait, and that none is lost."""

from __future__ import annotations

import signal
import weakref
from threading import Event

import pytest

from minirt.helpers.signals import ENDING, ended_by_signals, held_signals
from minirt.rendering.threads import ThreadPool
from tests import waiting
from tests.waiting import until

TERM = signal.SIGTERM


class Thing:
    """An object that weak references can name."""


@pytest.fixture(autouse=True)
def _hangs_are_short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(waiting, "HANG_LIMIT", 20.0)


@pytest.mark.parametrize("number", ENDING)
def test_the_first_signal_ends_the_work_and_further_ones_do_nothing(number: int) -> None:
    before = [signal.getsignal(each) for each in ENDING]
    with pytest.raises(KeyboardInterrupt) as ended, ended_by_signals():  # noqa: PT012
        try:
            signal.raise_signal(number)
        finally:
            for each in ENDING:
                signal.raise_signal(each)
    assert ended.value.args == (number,)
    assert [signal.getsignal(each) for each in ENDING] == before


def test_the_innermost_block_says_what_a_signal_does() -> None:
    came: list[int] = []
    with ended_by_signals():
        with ended_by_signals(came.append):
            signal.raise_signal(TERM)
            signal.raise_signal(TERM)
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(TERM)
    assert came == [TERM, TERM]


def test_signals_wait_for_the_end_of_a_block_that_holds_them() -> None:
    came: list[int] = []
    with pytest.raises(KeyboardInterrupt) as ended, ended_by_signals():  # noqa: PT012
        with held_signals(), held_signals() as held:
            signal.raise_signal(TERM)
            came += held
        came.append(-1)
    assert (came, ended.value.args) == ([TERM], (TERM,))


def test_an_interrupt_that_python_drops_comes_again() -> None:
    """A callback of a weak reference cannot raise."""
    thing = Thing()
    reference = weakref.ref(thing, lambda _: signal.raise_signal(TERM))
    with pytest.raises(KeyboardInterrupt) as ended, ended_by_signals():  # noqa: PT012
        del thing
        until(lambda: False, "the interrupt")
    assert (reference(), ended.value.args) == (None, (TERM,))


def test_an_interrupt_at_any_moment_waits_for_the_threads() -> None:
    """They write memory that the caller frees. Here it comes while an error of one of them cancels the others."""
    goes_on, done = Event(), list[str]()

    def work() -> None:
        goes_on.wait()
        done.append("work")

    def fail() -> None:
        raise ValueError

    def cancel() -> None:
        signal.raise_signal(TERM)
        goes_on.set()

    try:
        with pytest.raises(KeyboardInterrupt), ended_by_signals():
            ThreadPool(2).run([fail, work], cancel)
        assert done == ["work"]
    finally:
        goes_on.set()

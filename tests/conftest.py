"""Set up the tests: distribute them to all processors, and make them independent of the machine."""

from __future__ import annotations

import signal
import threading
from math import inf
from pathlib import Path
from typing import Any

import hypothesis.core
import pytest
from hypothesis import HealthCheck, settings

from tests import environment, scheduling, seeds
from tests.paths import ROOT
from tests.windows import desktop

__all__ = ["desktop"]

environment.prepare()  # before the compiler is imported, which reads the environment once

# A slow machine is no failure: hypothesis has no time limits.
settings.register_profile("miniRT", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("miniRT")
hypothesis.core.global_force_seed = seeds.RUN


@pytest.fixture(autouse=True, scope="session")
def without_specialised_kernels() -> None:
    """Let no renderer have the specialised kernel compiled that is worth its time from half a second of drawing on.

    On a slow machine most tests would begin that, in a process that is killed when they end. Tests that need a
    specialised kernel ask for it.
    """
    from minirt.rendering import kernels

    kernels.SPECIALISED_AFTER = inf


pytest_xdist_make_scheduler = pytest.hookimpl(optionalhook=True)(scheduling.make_scheduler)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """Return the number of processes: one more than the processors, since that of the windows mostly waits."""
    from minirt.rendering.threads import usable_cores

    return usable_cores() + 1


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say which seed replays the random tests."""
    terminalreporter.write_line(f"random tests: {seeds.VARIABLE}={seeds.RUN}")


def pytest_configure() -> None:
    """Give the programs of the tests the signals that the caller ignores, as `nohup make test &` in a script does.

    Programs that are started inherit ignored signals, but not handlers.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    for number in {getattr(signal, name, signal.SIGINT) for name in ("SIGHUP", "SIGQUIT", "SIGTERM")}:
        if signal.getsignal(number) is signal.SIG_IGN:
            signal.signal(number, lambda *_: None)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not even import the files that `make quick` leaves out."""
    if "not slow" in config.option.markexpr and collection_path.is_relative_to(ROOT):
        name = collection_path.relative_to(ROOT).as_posix() + ("/" if collection_path.is_dir() else "")
        return scheduling.is_slow(name) or None
    return None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark slow tests, and sort the largest groups first."""
    for item in items:
        if scheduling.is_slow(item.nodeid):
            item.add_marker(pytest.mark.slow)
    items.sort(key=lambda item: scheduling.order(item.nodeid))

"""Wait for conditions, never for a number of seconds.

No test compares a time with a limit, since machines and their loads differ. A test that needs an effect waits until it
has happened, however long that takes.
"""

from __future__ import annotations

import time
from collections.abc import Callable

HANG_LIMIT = 300.0  # seconds after which a wait counts as a hang: far above any expected time
POLL, SLOWEST_POLL = 0.01, 0.05  # seconds between two checks, at first and after long: a check may start a program


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait until `condition` holds. After `HANG_LIMIT` a TimeoutError says that `what` did not come."""
    deadline, pause = time.monotonic() + HANG_LIMIT, POLL
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"{what} did not come within {HANG_LIMIT:.0f} s")
        time.sleep(pause)
        pause = min(1.2 * pause, SLOWEST_POLL)

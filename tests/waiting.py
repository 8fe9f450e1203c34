"""Wait for events, never for seconds.

No test holds a time against a limit: machines differ, and other programs want their processors. A test that needs
something to happen waits until it has happened, however long that takes.
"""

from __future__ import annotations

import time
from collections.abc import Callable

HANG_LIMIT = 300.0  # seconds after which a wait counts as a hang; it asks nothing about speed
POLL = 0.01  # seconds between two looks


def until(condition: Callable[[], bool], what: str) -> None:
    """Wait until `condition` holds; TimeoutError, which says `what` did not come, after `HANG_LIMIT`."""
    deadline = time.monotonic() + HANG_LIMIT
    while not condition():
        if time.monotonic() > deadline:
            raise TimeoutError(f"{what} did not come within {HANG_LIMIT:.0f} s")
        time.sleep(POLL)

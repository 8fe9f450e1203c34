"""The viewer as a program whose clock stands still.

A key that is pressed and released moves one step however long that takes, and changes of one kind are undone together,
as in a replay without waits.

python -m tests.viewer.frozen_clock ARGUMENTS    # the arguments of miniRT
"""

from __future__ import annotations

import sys

from minirt.cli import main
from minirt.viewer.app.session import Session

if __name__ == "__main__":
    Session.now = property(lambda _: 0.0)  # type: ignore[method-assign,assignment]
    sys.exit(main())

"""The program with a clock that stands still: a key that goes down and up moves one step however long that takes, and
changes of one kind are undone together, as where lines are replayed without a wait.

python -m tests.viewer.frozen_clock ARGUMENTS    # those of miniRT
"""

from __future__ import annotations

import sys

from minirt.cli import main
from minirt.viewer.app.session import Session

if __name__ == "__main__":
    Session.now = property(lambda _: 0.0)  # type: ignore[method-assign,assignment]
    sys.exit(main())

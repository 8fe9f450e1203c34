"""Exit statuses of the program."""

from __future__ import annotations

OK = 0
FAILED = 1  # an error in a scene, in rendering or in writing
USAGE = 2  # wrong arguments
INTERRUPTED = 130  # Ctrl+C; 128 + n after another signal n

"""Which process runs which tests: files as a whole, so that what a file prepares is prepared once, and all that open
windows in one process, where they share a screen and do not disturb each other."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent
WINDOWS = "windows"  # the piece of work of all files that open some


@cache
def marked(file: str) -> bool:
    """Whether tests of a file open windows: whether its source has the mark."""
    return "pytest.mark.window" in (ROOT / file).read_text(encoding="utf-8")


def opens_windows(test: str) -> bool:
    """Whether a test, such as tests/viewer/test_walk.py::test_a_walk, is in a file that opens windows."""
    return marked(test.split("::", maxsplit=1)[0])


def piece_of_work(test: str) -> str:
    """What a test is run together with: its file, or all windows."""
    return WINDOWS if opens_windows(test) else test.split("::", maxsplit=1)[0]


def make_scheduler(config: pytest.Config, log: Any) -> Any:
    """The scheduler of pytest-xdist for these pieces of work, in the order in which pytest found them."""
    from xdist.scheduler import LoadScopeScheduling

    class Files(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return piece_of_work(nodeid)

    config.option.loadscopereorder = False
    return Files(config, log)

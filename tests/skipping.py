"""Skips of tests that ask for more of a new shape than its file and its oracle."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def skip_incomplete(reason: str) -> NoReturn:
    """Skip the test with the reason, which says what to add; fail it in continuous integration."""
    if os.environ.get("MINIRT_REQUIRE_WINDOW") == "1":
        pytest.fail(reason)
    pytest.skip(reason)

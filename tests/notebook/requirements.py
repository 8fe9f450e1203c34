"""Packages that tests of notebooks need, and the library does without."""

from __future__ import annotations

import os
from importlib.util import find_spec

import pytest


def require(*packages: str) -> None:
    """Skip the test where a package is missing; fail it in continuous integration, which installs all of them."""
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        reason = f"needs {', '.join(missing)}; install it: pip install --group dev"
        if os.environ.get("MINIRT_REQUIRE_WINDOW") == "1":
            pytest.fail(reason)
        pytest.skip(reason)

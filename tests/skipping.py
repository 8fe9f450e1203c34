"""Skips of tests that lack something: a program or package on the machine, or an entry for a new shape.

The command that installs programs is that of CONTRIBUTING.md.
"""

from __future__ import annotations

import os
import re
from importlib.util import find_spec
from typing import NoReturn

import pytest

from tests.paths import ROOT


def skip_incomplete(reason: str) -> NoReturn:
    """Skip the test with the reason, which says what to add or to install; fail it in continuous integration."""
    if os.environ.get("MINIRT_REQUIRE_WINDOW") == "1":
        pytest.fail(reason)
    pytest.skip(reason)


def install_command(package: str) -> str:
    """Return the command of CONTRIBUTING.md that installs a package of the system."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    return re.findall(rf"^apt-get install .*\b{package}.*$", text, re.MULTILINE)[0]


def require(*packages: str) -> None:
    """Skip the test where a Python package is missing that it needs; fail it in continuous integration."""
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        skip_incomplete(f"needs {', '.join(missing)}; install it: pip install --group dev")

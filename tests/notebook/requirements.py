"""Packages that tests of notebooks need, and the library does without; notebooks that tests write."""

from __future__ import annotations

import json
import os
from importlib.util import find_spec
from pathlib import Path

import pytest


def require(*packages: str) -> None:
    """Skip the test where a package is missing; fail it in continuous integration, which installs all of them."""
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        reason = f"needs {', '.join(missing)}; install it: pip install --group dev"
        if os.environ.get("MINIRT_REQUIRE_WINDOW") == "1":
            pytest.fail(reason)
        pytest.skip(reason)


KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}


def written(path: Path, *cells: str) -> Path:
    """Write a notebook with these cells of code, and return its path."""
    made = [
        {
            "cell_type": "code",
            "id": f"cell{number}",
            "metadata": {},
            "execution_count": None,
            "outputs": [],
            "source": cell,
        }
        for number, cell in enumerate(cells)
    ]
    notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": KERNEL}, "cells": made}
    path.write_text(json.dumps(notebook))
    return path

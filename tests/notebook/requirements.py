"""Packages that tests of notebooks need, and the library does without; notebooks that tests write."""

from __future__ import annotations

import json
from importlib.util import find_spec
from pathlib import Path

from tests.skipping import skip_incomplete


def require(*packages: str) -> None:
    """Skip the test where a package is missing; fail it in continuous integration, which installs all of them."""
    missing = [name for name in packages if find_spec(name) is None]
    if missing:
        skip_incomplete(f"needs {', '.join(missing)}; install it: pip install --group dev")


KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}


def written(path: Path, *cells: str) -> Path:
    """Write a notebook with these cells of code, and return its path."""
    cell = {"cell_type": "code", "metadata": {}, "execution_count": None, "outputs": []}
    made = [{**cell, "id": f"cell{number}", "source": source} for number, source in enumerate(cells)]
    notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": KERNEL}, "cells": made}
    path.write_text(json.dumps(notebook))
    return path

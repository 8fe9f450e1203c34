"""Notebooks that tests write."""

from __future__ import annotations

import json
from pathlib import Path

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

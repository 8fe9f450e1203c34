"""Paths of the project's folders."""

from __future__ import annotations

from pathlib import Path

import minirt

PACKAGE = Path(minirt.__file__).parent
ROOT = PACKAGE.parent
SCENES = ROOT / "scenes"
TESTS = ROOT / "tests"

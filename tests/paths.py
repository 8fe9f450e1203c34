"""Paths of the project's folders."""

from __future__ import annotations

from pathlib import Path

import minirt

PACKAGE = Path(minirt.__file__).parent
ROOT = PACKAGE.parent
SCENES = ROOT / "scenes"
TESTS = ROOT / "tests"


def scene_files() -> list[Path]:
    """Return the files of the project's scenes, without recovery files that a window has left beside them."""
    return sorted(path for path in SCENES.glob("*.rt") if ".recovered" not in path.stem)

"""Copy of the project in which mutation testing of host code changes files."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from tests.paths import ROOT

COPIED = ("minirt", "tests", "scenes", "assets", "pyproject.toml", "Makefile", "README.md", "CHANGELOG.md")
LIMITS = {  # what a changed program may use
    "RLIMIT_AS": 4 << 30,  # bytes of memory
    "RLIMIT_FSIZE": 1 << 28,  # bytes of a file
}


class ProjectCopy:
    """A copy of the project with a cache of kernels of its own, since a changed program may store wrong ones.

    Files are copied rather than linked: an editor that overwrites a file of the project does not change the copy.
    """

    def __init__(self, folder: Path, source: Path = ROOT) -> None:
        self.root = folder / "project"
        self.kernels = folder / "kernels"  # compiled by unchanged tests
        self.root.mkdir(parents=True)
        for name in COPIED:
            if (source / name).is_dir():
                shutil.copytree(source / name, self.root / name)
            elif (source / name).exists():
                shutil.copy2(source / name, self.root / name)

    def environment(self, cache: Path) -> dict[str, str]:
        """Environment variables under which this process and its programs import the copy and use a cache."""
        return {"PYTHONPATH": str(self.root), "XDG_CACHE_HOME": str(cache), "PYTHONHASHSEED": "0"}

    def fresh_cache(self) -> Path:
        """Remove what the last tests left behind, and return a folder with the kernels of the unchanged project."""
        shutil.rmtree(self.root / "out", ignore_errors=True)
        cache = self.root / "out" / "cache"
        if self.kernels.exists():
            shutil.copytree(self.kernels, cache, copy_function=os.link)
        return cache

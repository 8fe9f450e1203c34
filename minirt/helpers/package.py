"""Files that are installed beside the modules: tables, templates and pictures, in a folder or in a zip file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any


def read(module: str, name: str) -> bytes:
    """Return the contents of a file beside a module, which is given by its `__name__`. OSError where there is none.

    Python's loader reads it, so that a package in a zip file has it, too. `importlib.resources` does the same, but its
    import takes 46 ms, which the start of the program would take longer.
    """
    beside: Any = sys.modules[module]
    contents: bytes = beside.__spec__.loader.get_data(str(Path(beside.__file__).parent / name))
    return contents

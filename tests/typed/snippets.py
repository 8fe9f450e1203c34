"""Write the Python programs of the pages into files for type checkers: python -m tests.typed.snippets FOLDER"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.pages import programs

INSIDE = "minirt/README.md"  # the page about the modules of the library, whose names are not public


def write(folder: Path) -> list[Path]:
    """Write each program that uses the library into a file of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.py"):
        old.unlink()
    files = []
    for number, (page, text) in enumerate(programs()):
        if "minirt" in text and page != INSIDE:
            file = folder / f"{page.replace('/', '_').removesuffix('.md').lower()}_{number}.py"
            file.write_text(text, encoding="utf-8")
            files.append(file)
    return files


if __name__ == "__main__":
    write(Path(sys.argv[1]))

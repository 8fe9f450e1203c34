"""Write the Python snippets of the pages into files for type checkers: python -m tests.typed.snippets FOLDER"""

from __future__ import annotations

import sys
from pathlib import Path

from tests.pages import blocks

PAGES = ("README.md", "minirt/rendering/README.md")  # whose snippets use the library
SCENE = 'import minirt\n\nscene = minirt.load("scenes/demo.rt")\n\n'


def write(folder: Path) -> list[Path]:
    """Write each snippet, with the scene that it may use, into a file of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.py"):
        old.unlink()
    files = []
    for page in PAGES:
        for number, text in enumerate(blocks(page, "python")):
            file = folder / f"{page.replace('/', '_').removesuffix('.md').lower()}_{number}.py"
            file.write_text(text if "import minirt" in text else SCENE + text, encoding="utf-8")
            files.append(file)
    return files


if __name__ == "__main__":
    write(Path(sys.argv[1]))
